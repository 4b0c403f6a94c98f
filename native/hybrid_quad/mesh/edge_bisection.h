#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

struct BisectedMesh {
  TriangleMesh mesh;                            ///< vertices keep their ids, new ones follow
  std::vector<std::array<int, 2>> marked_edges;  ///< the parts of the marked edges
};

/// The same surface with no edge longer than `longest`: edges are halved, longest first (Rivara 1984), so that what is
/// known at vertices is known everywhere.
/// \param marked_edges  pairs of neighbouring vertices
BisectedMesh bisect_long_edges(const TriangleMesh& mesh, double longest, const std::vector<std::array<int, 2>>& marked_edges);

}  // namespace hybrid_quad
