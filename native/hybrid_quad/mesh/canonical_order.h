#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// An order of a mesh's vertices and half-edges that depends on the surface alone, not on the file that it came from.
struct CanonicalOrder {
  std::vector<int> vertex;    ///< #V: which comes where, by index into the mesh; isolated vertices are left out
  std::vector<int> halfedge;  ///< 3 #F: likewise; those of a face stay together and in their cyclic order
};

/// Breadth first from first_halfedge() of each component, the component with the longest edge first, of equal ones that farther
/// from the middle. Invariant under permutations of vertices and faces, and under rigid motions unless the mesh has symmetries.
/// \throws Cancelled
CanonicalOrder canonical_order(const TriangleMesh& mesh, const RunContext& context = {});

/// The mesh in another order.
/// \throws Cancelled
TriangleMesh reordered(const TriangleMesh& mesh, const CanonicalOrder& order, const RunContext& context = {});

}  // namespace hybrid_quad
