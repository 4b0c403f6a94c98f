#pragma once

#include <optional>

#include "hybrid_quad/pipeline/component.h"

namespace hybrid_quad {

/// Every triangle of a component in three quads, from the middles of its sides to its own: pure quads without any field, as with one step of
/// Catmull-Clark's subdivision (1978). They lie in the surface, and none points against it however that folds.
/// \param component  as it was given: its vertices are the first of the plan's mesh
/// \returns none where edges have both ends in common, or the plan's features end on an edge
std::optional<QuadMesh> split_triangles(const TriangleMesh& component, const ComponentPlan& plan);

/// Where quads of a component are flawed whatever was done, its own triangles make the result, if they are few enough and give fewer flawed.
/// \param wanted  number of quads  \param whole  the surface that the component is part of
void keep_triangles(const TriangleMesh& component, const ComponentPlan& plan, double wanted, const SurfaceIndex& whole, int threads,
                    ComponentResult& result);

}  // namespace hybrid_quad
