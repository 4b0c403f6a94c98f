#include "hybrid_quad/pipeline/scarce_quads.h"

#include <utility>

#include "hybrid_quad/pipeline/broken_promises.h"
#include "hybrid_quad/pipeline/component_pass.h"
#include "hybrid_quad/pipeline/features_give_way.h"
#include "hybrid_quad/pipeline/fewest_quads.h"
#include "hybrid_quad/pipeline/passes.h"

namespace hybrid_quad {

std::optional<ComponentResult> remesh_scarce(const ComponentPlan& planned, double wanted, const SurfaceIndex& whole, const Wishes& wishes,
                                             const HardGuides& guides, const RemeshOptions& options, WorkBudget& budget, StageClock& clock,
                                             const RunContext& context) {
  constexpr double kMost = 1.2, kMostInSketch = 2;  // times the number
  constexpr double kSpeck = 16;  // quads: two passes take next to no time
  const bool may_give_way = planned.is_scarce && options.is_by_count() && planned.guides.empty() && planned.asked_chains.empty();
  if (!may_give_way) return std::nullopt;
  const ComponentPlan without = without_features_by_angle(planned, options.symmetry.planes, context);
  if (without.given_way == planned.given_way) return std::nullopt;
  const double number = std::max<double>(wanted, fewest_quads(planned.mesh));
  const auto is_held = [&](const QuadMesh& quads, double most) { return static_cast<double>(quads.quads.size()) > most * number; };
  const RunContext first = context.in_stage(context.stage, 0, 0.4);
  ComponentResult best;
  bool any = false;
  try {
    ComponentPass pass(planned, whole, wishes, guides, options, PassSettings{});
    if (!is_held(pass.sketch(clock, first), kMostInSketch)) {
      best = remesh_in_passes(planned, pass.complete(clock, first), wanted, whole, wishes, guides, options, budget, clock, first);
      any = true;
      if (planned.quads > kSpeck || (best.flawed_quads == 0 && !is_held(best.mesh, kMost))) return best;
    }
  } catch (const InternalError& error) {
    record_broken_promise(error, best.repairs, best.warnings);
  }
  ComponentResult fewer = remesh_in_passes(without, std::nullopt, wanted, whole, wishes, guides, options, budget, clock,
                                           context.in_stage(context.stage, 0.4, 1));
  if (any && (best.flawed_quads < fewer.flawed_quads || best.mesh.quads.size() <= fewer.mesh.quads.size()))
    std::swap(best, fewer);
  keep_broken_promises(best, fewer);
  return fewer;
}

}  // namespace hybrid_quad
