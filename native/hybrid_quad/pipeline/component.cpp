#include "hybrid_quad/pipeline/component.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "hybrid_quad/pipeline/broken_promises.h"
#include "hybrid_quad/pipeline/component_pass.h"
#include "hybrid_quad/pipeline/fewest_quads.h"
#include "hybrid_quad/pipeline/first_pass.h"
#include "hybrid_quad/pipeline/missed_loops.h"
#include "hybrid_quad/pipeline/passes.h"
#include "hybrid_quad/pipeline/scarce_quads.h"

namespace hybrid_quad {

namespace {

/// Further passes with corners where the loops of `best` are farthest from their guides; one that has them nearer and is as
/// sound takes its place.
void mend_loops(const ComponentPlan& planned, double wanted, const SurfaceIndex& whole, const Wishes& wishes,
                const HardGuides& guides, const RemeshOptions& options, ComponentResult& best, WorkBudget& budget,
                StageClock& clock, const RunContext& context) {
  constexpr int kTries = 3;
  ComponentPlan plan = planned;
  MissedLoops missed = missed_loops(planned, guides, best);
  double least_excess = missed.excess;
  for (int i = 0; i < kTries && !missed.places.empty(); ++i) {
    try {
      plan = with_corners(plan, missed.places, options.symmetry.planes, context);
      ComponentResult result = remesh_in_passes(plan, std::nullopt, wanted, whole, wishes, guides, options, budget, clock, context);
      result.passes += best.passes;
      best.passes = result.passes;
      missed = missed_loops(plan, guides, result);
      const bool is_sound = result.flawed_quads <= best.flawed_quads && result.missed_counts <= best.missed_counts;
      if (!is_sound || missed.excess >= least_excess) {
        keep_broken_promises(result, best);
        continue;
      }
      least_excess = missed.excess;
      keep_broken_promises(best, result);
      best = std::move(result);
    } catch (const InternalError& error) {
      record_broken_promise(error, best.repairs, best.warnings);
      return;
    }
  }
}

/// At the very last, as marked edges do, what asks for edges of its own gives way to sound quads, and to a number of quads that is not far
/// beyond what is wanted.
void let_exact_wishes_give_way(const ComponentPlan& planned, double wanted, const SurfaceIndex& whole, const Wishes& wishes,
                               const HardGuides& guides, const RemeshOptions& options, ComponentResult& best, WorkBudget& budget,
                               StageClock& clock, const RunContext& context) {
  const std::optional<ComponentPlan> plan = without_exact_wishes(planned, guides, options.symmetry.planes, context);
  if (!plan) return;
  constexpr double kFarTooMany = 10;
  const double as_many = wanted * plan->quads / planned.quads;
  const auto excess = [&](const ComponentResult& result) {
    return static_cast<double>(result.mesh.quads.size()) / std::max<double>(as_many, fewest_quads(plan->mesh));
  };
  if (best.flawed_quads == 0 && excess(best) <= kFarTooMany) return;
  try {
    ComponentResult result = remesh_in_passes(*plan, std::nullopt, as_many, whole, wishes, guides, options, budget, clock, context);
    result.passes += best.passes;
    best.passes = result.passes;
    const bool is_better =
        result.flawed_quads < best.flawed_quads ||
        (result.flawed_quads == best.flawed_quads && excess(best) > kFarTooMany && excess(result) < excess(best));
    if (is_better) std::swap(best, result);
    keep_broken_promises(result, best);
  } catch (const InternalError& error) {
    record_broken_promise(error, best.repairs, best.warnings);
  }
}

}  // namespace

ComponentPreview preview_component(const ComponentPlan& planned, double wanted, const SurfaceIndex* whole,
                                   const Wishes& wishes, const HardGuides& guides, const RemeshOptions& options,
                                   StageClock& clock, const RunContext& context) {
  const Extractable found = extractable(planned, std::max<double>(wanted, fewest_quads(planned.mesh)));
  PassSettings settings;
  settings.is_rough = found.rough.has_value();
  return preview_pass(found.rough ? *found.rough : planned, whole, wishes, guides, options, settings, clock, context);
}

ComponentResult remesh_component(const ComponentPlan& planned, double wanted, const SurfaceIndex& whole, const Wishes& wishes,
                                 const HardGuides& guides, const RemeshOptions& options, WorkBudget& budget, StageClock& clock,
                                 const RunContext& context) {
  const bool is_extractable = !extractable(planned, std::max<double>(wanted, fewest_quads(planned.mesh))).are_few;
  std::optional<FirstPass> first;
  if (std::optional<ComponentResult> scarce = remesh_scarce(planned, wanted, whole, wishes, guides, options, budget, clock, context))
    return *std::move(scarce);
  ComponentResult broken;
  if (is_extractable) first = first_pass_by_trial(planned, whole, wishes, guides, options, clock, context, broken);
  const ComponentPlan& plan = first ? first->plan : planned;
  // Where lengths count, a plan with shorter ones is for more quads; and a wire has four quads around, whatever the number.
  const double planned_for = wanted * plan.quads / planned.quads;
  const double number = !options.is_by_count()       ? planned_for
                        : plan.thin_stretch.is_any() ? std::max(wanted, planned_for)
                                                     : wanted;
  ComponentResult best = remesh_in_passes(plan, first ? std::optional(std::move(first->result)) : std::nullopt, number, whole,
                                          wishes, guides, options, budget, clock, context);
  keep_broken_promises(broken, best);
  if (!planned.guides.empty() && options.improve)
    mend_loops(planned, wanted, whole, wishes, guides, options, best, budget, clock, context);
  let_exact_wishes_give_way(plan, number, whole, wishes, guides, options, best, budget, clock, context);
  return best;
}

}  // namespace hybrid_quad
