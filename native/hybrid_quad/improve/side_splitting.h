#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// Ways to fill the hexagon (a, m1, m2, b, c, d) that a quad (a, b, c, d) becomes when its side a b is split in three: by an edge
/// m1 c or m2 d, by three edges from a new vertex inside to a, m2, c or to m1, b, d, or by two new vertices inside, each
/// joined to one of m1 and m2.
enum class HexagonFill { kFirstEdge, kSecondEdge, kStarAtFirst, kStarAtSecond, kInset };

/// A side of a quad split in three, and what fills the hexagons on both sides of it.
struct SideSplit {
  int quad = -1, side = 0;
  double first = 1.0 / 3, second = 2.0 / 3;  ///< where the new vertices are, as parts of the side
  HexagonFill fill = HexagonFill::kInset;
  HexagonFill fill_across = HexagonFill::kInset;  ///< seen from there; without meaning on the boundary
};

/// Whether both new vertices of the side have as many quads as a vertex there needs.
bool is_sound(const SideSplit& split, bool on_boundary);

/// All ways to fill both sides of a quad's side, its new vertices at thirds, that are sound.
std::vector<SideSplit> sound_splits(int quad, int side, bool on_boundary);

/// The point at some part of the way from a to b, which are the ends of a side: along the feature curve if `edge` is not null.
/// \param piece  of `mesh`, located (Workpiece::locate_all)
Vector3 point_on_side(const QuadMesh& mesh, const Workpiece& piece, const QuadMesh::FeatureEdge* edge, int a, int b, double part);

/// Four points along a side, its ends and the new vertices, for SideSplitter::split.
/// \param edge  its feature edge, null: none  \param piece  as for point_on_side
std::array<Vector3, 4> path_of(const QuadMesh& mesh, const Workpiece& piece, const QuadMesh::FeatureEdge* edge, const SideSplit& split);

/// Whether the number of edges of a feature edge's curve may change: not where somebody asked for one. \param edge  null: no feature
bool may_split(const QuadMesh::FeatureEdge* edge, const FeatureGraph& features);

/// Splits sides of quads, with feature edges along curves; the rest of the mesh stays as it is, and so does its topology.
class SideSplitter {
 public:
  /// \param region  #Q: the part of the surface (FeatureGraph::face_region) on which a quad's new vertices inside are put, -1: any
  SideSplitter(const QuadMesh& mesh, const SurfaceIndex& surface, std::vector<int> region);

  /// The quad beyond a side, -1 on the boundary.
  int across(int quad, int side) const;
  /// The feature edge between two vertices, in either direction; null where there is none.
  const QuadMesh::FeatureEdge* feature_edge(int a, int b) const;
  /// The mesh with that side split.
  /// \param path  four points along the side, its ends included: the new vertices are the two between
  /// \param changed  the quads that are new or other than before
  /// \pre is_sound(split)
  QuadMesh split(const SideSplit& split, const std::array<Vector3, 4>& path, std::vector<int>* changed) const;

 private:
  struct Hexagon {
    int a, m1, m2, b, c, d;
  };
  void fill(QuadMesh& out, int quad, const Hexagon& hexagon, HexagonFill how, std::vector<int>* changed) const;
  int add_inside(QuadMesh& out, int quad, const Vector3& position) const;

  const QuadMesh& mesh_;
  const SurfaceIndex& surface_;
  std::vector<int> region_;
  std::vector<std::vector<int>> quads_at_;
};

}  // namespace hybrid_quad
