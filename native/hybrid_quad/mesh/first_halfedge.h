#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// The middle of some faces' area.
Vector3 middle_of(const TriangleMesh& mesh, const std::vector<int>& faces);

/// The half-edge of a component with which its canonical order begins: one of the longest; of these the one that is farthest
/// from the middle, in the order of its corners and of those around it. Lengths and distances count as equal when rounding
/// can make them differ; what is equal in all of them is so by a symmetry of the component, or nearly, and coordinates decide.
/// \param faces  of the component, in any order
/// \throws Cancelled
int first_halfedge(const TriangleMesh& mesh, const std::vector<int>& faces, const RunContext& context = {});

}  // namespace hybrid_quad
