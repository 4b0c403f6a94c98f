#pragma once

#include <vector>

#include "hybrid_quad/pipeline/component.h"
#include "hybrid_quad/pipeline/run_plan.h"

namespace hybrid_quad {

/// Components that are remeshed side by side, each wave after the one before it: the smallest that together make up half of the quads that are
/// left, one at least.
/// \returns indices of the plans, the smallest first
std::vector<std::vector<int>> component_waves(const std::vector<ComponentPlan>& plans);

/// Remeshes all components. What those of a wave cost more or less than planned, the later ones pay or get (docs/decisions/0049); how many
/// threads there are makes no difference to the result.
/// \param run  whose plans are scaled by what is paid or got
/// \param whole  the surface that the components are part of
/// \throws Cancelled, InternalError as remesh_component()
std::vector<ComponentResult> remesh_components(RunPlan& run, const SurfaceIndex& whole, StageClock& clock);

}  // namespace hybrid_quad
