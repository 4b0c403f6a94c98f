#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/spanning_parameterization/lifted_grid.h"
#include "hybrid_quad/spanning_parameterization/spanning_parameterization.h"

namespace hybrid_quad {

/// Moves dislocations through the surface until they meet and vanish, a cone takes them in, or they leave
/// over a feature or boundary that they slide along (docs/decisions/0004). Always the shortest move
/// first. Only jumps change, and the values of cones that took something in.
void cancel_dislocations(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
                         const SpanningOptions& options, const RunContext& context, LiftedGrid& grid);

int count_dislocations(const TriangleMesh& mesh, const LiftedGrid& grid);

}  // namespace hybrid_quad
