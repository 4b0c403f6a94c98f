#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// An order of a mesh's vertices and half-edges that depends on the surface alone, not on the file that it came from.
struct CanonicalOrder {
  std::vector<int> vertex;    ///< #V: which comes where, by index into the mesh; isolated vertices are left out
  std::vector<int> halfedge;  ///< 3 #F: likewise; those of a face stay together and in their cyclic order
};

/// Breadth first from the longest edge of each component, the component with the longest of them first. Invariant under
/// permutations of vertices and faces, and under rigid motions as long as rounding leaves the longest edge the longest.
CanonicalOrder canonical_order(const TriangleMesh& mesh);

/// The mesh in another order.
TriangleMesh reordered(const TriangleMesh& mesh, const CanonicalOrder& order);

}  // namespace hybrid_quad
