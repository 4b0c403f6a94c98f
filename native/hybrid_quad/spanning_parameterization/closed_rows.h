#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/spanning_parameterization/movable_grid.h"

namespace hybrid_quad {

/// Loops of edges that generate the first homology of a surface, from a tree of its vertices and a tree of its faces that do
/// not cross (tree and cotree: Erickson and Whittlesey, Greedy optimal homotopy and homology generators, SODA 2005). A set of loops
/// is a number with a bit for each.
class GeneratingLoops {
 public:
  using Set = std::uint64_t;

  explicit GeneratingLoops(const TriangleMesh& mesh);

  /// Whether there are no more than fit.
  bool fit() const { return loops_ <= 64; }
  /// Those that the edge of half-edge h is part of.
  Set through(int h) const { return through_[h]; }
  /// Those around which the jumps' sums are odd, that is, Psi changes its sign.
  /// \pre sums around all faces and cones are even
  Set odd(const LiftedGrid& grid) const;

 private:
  struct TreeEdge {
    int vertex, parent, halfedge;  ///< which joins them, either way
  };
  const TriangleMesh& mesh_;
  std::vector<TreeEdge> tree_;  ///< parents first
  std::vector<int> closing_;    ///< the half-edge that closes each loop
  std::vector<Set> through_;
  std::size_t loops_ = 0;
};

/// A row of quads that closes, to be taken out or put in: what a row's end does that goes once around.
struct ClosedRow {
  IntVector2 burgers{0, 0};  ///< in the first face
  std::vector<int> crossed;  ///< half-edges, each in the face that is left
};

/// The shortest closed row through the first of some faces that has one which crosses each of the wanted loops an odd number
/// of times, and each other an even number; where there is none, one that leaves fewer loops to be crossed.
/// \param states_left  places and directions that may be looked at, less those that were
std::optional<ClosedRow> shortest_closed_row(const MovableGrid& grid, const GeneratingLoops& loops, GeneratingLoops::Set wanted,
                                             const std::vector<int>& faces, std::size_t& states_left,
                                             const RunContext& context);

}  // namespace hybrid_quad
