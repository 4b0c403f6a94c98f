#pragma once

#include <optional>

#include "hybrid_quad/pipeline/component.h"

namespace hybrid_quad {

/// A first pass over a component and the plan that it follows.
struct FirstPass {
  ComponentPlan plan;
  ComponentResult result;
};

/// The best of some first passes, by shapes and distance, where plans differ in what they give room to: where features by angle are shorter
/// than quads, passes with all and with fewer of them (docs/decisions/0043); where the quads of that end short of tubes and tips, up to two
/// more with shorter edges there (docs/decisions/0052), and up to two with quads that are longer along them (docs/decisions/0053). For as many
/// quads, unless lengths were asked for instead of a number; but wires may get more.
/// \param broken  gets the promises that broke
/// \returns none where there is one plan only, or no pass came to an end
std::optional<FirstPass> first_pass_by_trial(const ComponentPlan& planned, const SurfaceIndex& whole, const Wishes& wishes,
                                             const HardGuides& guides, const RemeshOptions& options, StageClock& clock,
                                             const RunContext& context, ComponentResult& broken);

}  // namespace hybrid_quad
