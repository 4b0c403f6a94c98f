#pragma once

#include <optional>

#include "hybrid_quad/pipeline/component.h"

namespace hybrid_quad {

/// How a number of quads can be come by on a component.
struct Extractable {
  bool are_few = false;  ///< quads to be taken out afterwards
  std::optional<ComponentPlan> rough;  ///< for more quads than there are to be; none: the plan as it is
};

/// Far fewer quads than handles call for can't be extracted; they are taken out afterwards. Not along features, whose
/// edges stay: fewer are to be asked for from the start. \param count  of quads
Extractable extractable(const ComponentPlan& planned, double count);

/// Passes through the stages, with other settings each, until one has no flawed quads; the best of them.
/// \param first  the first of them, where it was made already  \param wanted  as for remesh_component
/// \throws InternalError  every pass broke a promise
ComponentResult remesh_in_passes(const ComponentPlan& planned, std::optional<ComponentResult> first, double wanted,
                                 const SurfaceIndex& whole, const Wishes& wishes, const HardGuides& guides,
                                 const RemeshOptions& options, WorkBudget& budget, StageClock& clock,
                                 const RunContext& context);

}  // namespace hybrid_quad
