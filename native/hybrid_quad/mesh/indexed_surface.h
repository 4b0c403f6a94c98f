#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/mesh/mesh_builder.h"

namespace hybrid_quad {

/// A triangle mesh whose vertices alone say which faces join.
struct IndexedSurface {
  std::vector<Vector3> positions;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> input_vertex;  ///< #V: polygon-soup vertex it came from, -1: in the middle of an edge
  std::vector<int> input_face;    ///< #F: polygon it is part of
};

/// The built mesh for programs that know nothing of half-edges: each fan of faces gets a vertex of its own, and of edges that
/// have the same two ends, as where sheets were cut apart along one edge, each is halved.
IndexedSurface indexed_surface(const BuiltMesh& built);

}  // namespace hybrid_quad
