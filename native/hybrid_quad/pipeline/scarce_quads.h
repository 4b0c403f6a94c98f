#pragma once

#include <optional>

#include "hybrid_quad/pipeline/component.h"

namespace hybrid_quad {

/// Where quads are scarce, features by angle are kept if not far more quads than wanted follow them: on specks what they cost more the rest of
/// the surface would pay, and between handles they hold a multiple (docs/decisions/0056).
/// \returns none where quads are not scarce, where lengths, guides or numbers along edges count as well, or where there are no features that may give way
std::optional<ComponentResult> remesh_scarce(const ComponentPlan& planned, double wanted, const SurfaceIndex& whole, const Wishes& wishes,
                                             const HardGuides& guides, const RemeshOptions& options, WorkBudget& budget, StageClock& clock,
                                             const RunContext& context);

}  // namespace hybrid_quad
