#include "hybrid_quad/pipeline/component.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/pipeline/broken_promises.h"
#include "hybrid_quad/pipeline/common_progress.h"
#include "hybrid_quad/pipeline/component_pass.h"
#include "hybrid_quad/pipeline/fewest_quads.h"
#include "hybrid_quad/pipeline/first_pass.h"
#include "hybrid_quad/pipeline/last_means.h"
#include "hybrid_quad/pipeline/missed_loops.h"
#include "hybrid_quad/pipeline/settle_count.h"
#include "hybrid_quad/sizing/feature_size.h"

namespace hybrid_quad {

namespace {

/// The first are the defaults; the others are tried, in this order, only where quads came out that fold or have no area,
/// each with shorter edges where that happened before.
constexpr PassSettings kSettings[] = {{},
                                      {1.03, 1e-4, PassKind::kAgain},
                                      {0.98, 1e-5, PassKind::kAgain},
                                      {1.0, 1e-4, PassKind::kWithoutFeatures},
                                      {1.0, 1e-4, PassKind::kAsNeeded},
                                      {1.3, 1e-4, PassKind::kAsNeeded},
                                      {1.8, 1e-5, PassKind::kAsNeeded},
                                      {2.5, 1e-4, PassKind::kAsNeeded},
                                      {4.0, 1e-5, PassKind::kAsNeeded},
                                      {3.2, 1e-4, PassKind::kAsNeeded},
                                      {5.0, 1e-4, PassKind::kAsNeeded}};

bool is_only_for_flawed(PassKind kind) { return kind == PassKind::kWithoutFeatures || kind == PassKind::kAsNeeded; }

/// So many flawed quads are not mended by another pass with as few: the surface is thinner than quads are long. More are taken out
/// again afterwards.
constexpr int kMany = 12;
bool is_hopeless(const PassSettings& settings, const ComponentResult& best) {
  return best.flawed_quads > kMany && !is_only_for_flawed(settings.kind);
}

/// Features that hold more quads than there are to be put their number out of reach anyway. Where passes with as few quads are in vain,
/// one with enough for them leaves hardly any flawed; settling takes out again what can go without.
constexpr double kHeldByFeatures = 1.25, kHeldFromTheStart = 2, kEnoughForFeatures = 2.5;  // times the number wanted

/// Doubtful quads alone are a reason for another pass where they are few, and as long as not too many quads were extracted,
/// of those that fit: where sheets touch there are about as many after every pass, and where each takes several tries to
/// come near the asked count, as on broken surfaces, all passes would take minutes.
bool is_done(const ComponentResult& best, double extracted, double quads) {
  constexpr int kFewDoubtful = 5;
  constexpr double kMostWork = 12;
  return best.flawed_quads == 0 &&
         ((best.doubtful_quads > kFewDoubtful && best.missed_counts == 0) || extracted > kMostWork * quads);
}

/// Flawed quads, each the worse the more quads were spent; missed counts only where there are none, then doubtful ones.
double badness(const ComponentResult& result) {
  const double quads = static_cast<double>(result.mesh.quads.size());
  return (result.flawed_quads + 1e-4 * result.missed_counts + 1e-8 * result.doubtful_quads) * quads;
}

bool has_inner_features(const ComponentPlan& plan) {
  for (int h = 0; h < plan.mesh.halfedge_count(); ++h)
    if (plan.features.is_feature(h) && plan.mesh.opposite(h) >= 0) return true;
  return false;
}

struct Extractable {
  bool are_few = false;  ///< quads to be taken out afterwards
  std::optional<ComponentPlan> rough;  ///< for more quads than there are to be; none: the plan as it is
};

/// Far fewer quads than handles call for can't be extracted; they are taken out afterwards. Not along features, whose
/// edges stay: fewer are to be asked for from the start.
Extractable extractable(const ComponentPlan& planned, double count) {
  constexpr double kExtractable = 0.5;
  const double least = kExtractable * quads_for_topology(planned.mesh);
  Extractable out;
  out.are_few = planned.guides.empty() && count < least && planned.quads < least;
  if (out.are_few && !has_inner_features(planned)) scale_plan(out.rough.emplace(planned), least / planned.quads);
  return out;
}

/// Passes until one has no flawed quads; the best of them. \param first  the first of them, where it was made already
ComponentResult remesh_in_passes(const ComponentPlan& planned, std::optional<ComponentResult> first, double wanted, const SurfaceIndex& whole, const Wishes& wishes,
                                 const HardGuides& guides, const RemeshOptions& options, WorkBudget& budget, StageClock& clock,
                                 const RunContext& context) {
  const double count = std::max<double>(wanted, fewest_quads(planned.mesh));
  const Extractable found = extractable(planned, count);
  const bool are_few = found.are_few, is_rough = found.rough.has_value();
  ComponentResult best;
  ComponentPlan fewer_features;
  const ComponentPlan* plan_of_best = &planned;
  std::string broken;
  constexpr int kWorse = 2;  // times as many flawed with shorter edges: with still shorter ones there are more
  bool any = false, needs_more = false;  // than there are to be
  std::size_t split_in_vain = 0;  // quads of the best, where splits did not put it right
  double begin = 0, end = 0.9, extracted = 0, first_work = 0;
  const double reserve = 0.5 * budget.left;  // for the components that follow
  std::vector<LengthLimit> limits;
  std::vector<Vector3> flawed;
  for (PassSettings settings : kSettings) {
    settings.is_rough = is_rough;
    if (any && is_only_for_flawed(settings.kind) && best.flawed_quads == 0) break;
    if (any && is_hopeless(settings, best)) continue;
    const bool without_features = settings.kind == PassKind::kWithoutFeatures, as_needed = settings.kind == PassKind::kAsNeeded;
    if (needs_more && !without_features && settings.quads_factor < kEnoughForFeatures) continue;
    if (without_features) {
      fewer_features = without_features_at(planned, flawed, options.symmetry.planes, context);
      if (fewer_features.given_way == planned.given_way) continue;
    }
    const ComponentPlan& plan = without_features ? fewer_features : is_rough ? *found.rough : planned;
    if (any && is_done(best, extracted, plan.quads)) break;
    const bool refined = !limits.empty() || settings.quads_factor != 1 || as_needed;
    const ComponentPlan finer = refined ? refined_plan(plan, settings.quads_factor, as_needed, limits, context) : ComponentPlan{};
    const double growth = refined ? std::max(settings.quads_factor, finer.quads / plan.quads) : 1;
    if (any && budget.left - growth * first_work < (needs_more ? 0 : reserve)) {
      best.gave_up = best.flawed_quads > 0;
      break;
    }
    try {
      const RunContext pass = context.in_stage(context.stage, begin, end);
      ComponentResult result = first ? *std::exchange(first, std::nullopt)
                                     : run_pass(refined ? finer : plan, whole, wishes, guides, options, settings, clock, pass);
      limits.insert(limits.end(), result.limits.begin(), result.limits.end());
      flawed.insert(flawed.end(), result.flawed_places.begin(), result.flawed_places.end());
      const ComponentPlan& unrefined = without_features ? fewer_features : planned;
      if (are_few) settle_count(unrefined, count, whole, wishes, options, result, clock, pass);
      // A few splits change less than other passes, which have other quads everywhere.
      std::size_t in_vain = 0;
      if ((!any || needs_more) && result.flawed_quads > 0 && result.flawed_quads <= kMany) {
        LastMeans(unrefined, count, whole, wishes, guides, options, budget, clock, pass).split_flawed(result);
        if (result.flawed_quads > 0) in_vain = result.mesh.quads.size();
      }
      const bool is_in_vain = as_needed && any && result.flawed_quads > kWorse * best.flawed_quads;
      result.passes = best.passes + 1;
      extracted += result.extracted_quads;
      if (any)
        budget.left -= result.work;
      else
        first_work = result.work;
      if (!any || badness(result) < badness(best)) {
        keep_broken_promises(best, result);
        best = std::move(result);
        plan_of_best = &unrefined;
        split_in_vain = in_vain;
      } else {
        best.passes = result.passes;
        keep_broken_promises(result, best);
      }
      const double quads = static_cast<double>(best.mesh.quads.size());
      if (!any && quads > kHeldFromTheStart * count) needs_more = true;
      any = true;
      if (best.doubtful_quads == 0 && best.missed_counts == 0) break;
      if (is_in_vain && (needs_more || quads < kHeldByFeatures * count)) break;
      if (is_in_vain) {
        needs_more = true;
        limits.clear();
      }
    } catch (const InternalError& error) {
      broken = error.what();
      ++best.passes;
      record_broken_promise(error, best.repairs, best.warnings);
    }
    begin = end;
    end += 0.5 * (1 - end);
  }
  if (!any) throw InternalError("remesh", broken);
  if (!are_few) settle_count(*plan_of_best, count, whole, wishes, options, best, clock, context);
  LastMeans last(*plan_of_best, count, whole, wishes, guides, options, budget, clock, context);
  last.put_flawed_right(best, best.mesh.quads.size() != split_in_vain);
  last.improve_poor(best);
  return best;
}

/// Where quads are scarce, features by angle are kept if not far more quads than wanted follow them: on specks what they cost more the rest of
/// the surface would pay, and between handles they hold a multiple (docs/decisions/0056).
/// \returns none where there are no features that may give way
std::optional<ComponentResult> remesh_scarce(const ComponentPlan& planned, double wanted, const SurfaceIndex& whole, const Wishes& wishes,
                                             const HardGuides& guides, const RemeshOptions& options, WorkBudget& budget, StageClock& clock,
                                             const RunContext& context) {
  constexpr double kMost = 1.2, kMostInSketch = 2;  // times the number
  constexpr double kSpeck = 16;  // quads: two passes take next to no time
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
  if (planned.is_scarce && options.is_by_count() && planned.guides.empty())
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
