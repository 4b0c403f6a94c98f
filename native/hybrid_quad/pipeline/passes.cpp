#include "hybrid_quad/pipeline/passes.h"

#include <algorithm>
#include <utility>

#include "hybrid_quad/pipeline/broken_promises.h"
#include "hybrid_quad/pipeline/component_pass.h"
#include "hybrid_quad/pipeline/fewest_quads.h"
#include "hybrid_quad/pipeline/last_means.h"
#include "hybrid_quad/pipeline/settle_count.h"

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

}  // namespace

Extractable extractable(const ComponentPlan& planned, double count) {
  constexpr double kExtractable = 0.5;
  const double least = kExtractable * quads_for_topology(planned.mesh);
  Extractable out;
  out.are_few = planned.guides.empty() && count < least && planned.quads < least;
  if (out.are_few && !has_inner_features(planned)) scale_plan(out.rough.emplace(planned), least / planned.quads);
  return out;
}

ComponentResult remesh_in_passes(const ComponentPlan& planned, std::optional<ComponentResult> first, double wanted,
                                 const SurfaceIndex& whole, const Wishes& wishes, const HardGuides& guides,
                                 const RemeshOptions& options, WorkBudget& budget, StageClock& clock,
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

}  // namespace hybrid_quad
