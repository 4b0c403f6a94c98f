#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/improve/edit_mesh.h"

namespace hybrid_quad {

/// How far the number of quads at a vertex is from what it should be: the squared difference to four inside; on a
/// feature, sector by sector, to the number that the sector's angle asks for. A sector whose quads would be nearly
/// straight (over 140 degrees each) costs 20 more, a vertex inside with fewer than three quads too.
double valence_cost(const EditMesh& mesh, int v);
/// True for a vertex one of whose quads cannot have a good shape whatever its vertices do.
bool has_straight_corner(const EditMesh& mesh, int v);

/// The two moves of which all others are made: a quad shrinks to one of its diagonals' middle, or the edge between two
/// quads turns in their hexagon. And a shrinking that leaves a vertex beside the diagonal only two quads: they become one.
struct Move {
  enum Kind : char { kCollapse, kRotateBack, kRotateForth, kCollapseAndMerge };
  Kind kind;
  int quad;
  int corner;  ///< collapse: a corner of the diagonal; rotation: the side
  bool collapses() const { return kind == kCollapse || kind == kCollapseAndMerge; }
};

/// Moves to be made one after the other.
struct Sequence {
  double cost = 0;  ///< change of the valence cost, and a little for every move
  int length = 0;
  std::array<Move, 3> moves{};
};

/// Vertices whose valence a move changes.
struct Changed {
  std::array<int, 6> vertex{-1, -1, -1, -1, -1, -1};
};

/// The hexagon a b x y c d of two quads (b, c, d, a) and (c, b, x, y) whose common edge b c turns.
struct Hexagon {
  int a, b, x, y, c, d, other;
};

/// The two ends of a collapse: the vertex that goes is always one inside that no feature holds.
/// \returns whether there is such a vertex
bool collapse_ends(const EditMesh& mesh, const Move& move, int* kept, int* gone);
/// \returns false where the move's edge is on the boundary
bool hexagon_of(const EditMesh& mesh, const Move& move, Hexagon* hexagon);
/// Vertices beside the diagonal that go too, as the two quads that they are left with become one; kCollapseAndMerge only.
std::vector<int> merged_away(const EditMesh& mesh, const Move& move);
/// Whether the mesh stays valid: no double edges, no vertex below its least valence, features and boundary untouched.
bool may_move(const EditMesh& mesh, const Move& move, Changed* changed);
/// \pre may_move
void make_move(EditMesh& mesh, const Move& move);
/// By how much the move raises the valence cost. The mesh stays as it is. \pre may_move, which gave `changed`
double cost_of_move(EditMesh& mesh, const Move& move, const Changed& changed);

}  // namespace hybrid_quad
