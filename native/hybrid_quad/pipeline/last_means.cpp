#include "hybrid_quad/pipeline/last_means.h"

#include <utility>
#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/pipeline/broken_promises.h"
#include "hybrid_quad/pipeline/component_pass.h"
#include "hybrid_quad/pipeline/settle_count.h"
#include "hybrid_quad/pipeline/validity.h"

namespace hybrid_quad {

LastMeans::LastMeans(const ComponentPlan& plan, double count, const SurfaceIndex& whole, const Wishes& wishes,
                     const HardGuides& guides, const RemeshOptions& options, WorkBudget& budget, StageClock& clock,
                     const RunContext& context)
    : planned_(plan), count_(count), whole_(whole), wishes_(wishes), guides_(guides), options_(options), budget_(budget),
      clock_(clock), context_(context) {}

void LastMeans::split_flawed(ComponentResult& result) const {
  if (result.flawed_quads > 0 && !keeps_numbers()) result.repairs.split_sides += apply(&Finishing::split_flawed, finishing(), result);
}

void LastMeans::put_flawed_right(ComponentResult& result, bool may_split) {
  if (keeps_numbers()) return;
  if (may_split) split_flawed(result);
  if (result.flawed_quads > 0) result.repairs.refined_places += apply(&Finishing::refine_flawed, finishing(), result);
  if (result.flawed_quads > 0) let_marks_give_way(result);
}

void LastMeans::improve_poor(ComponentResult& result) const {
  if (options_.improve && !keeps_numbers()) {
    const Finishing finishing = this->finishing();
    result.repairs.reached_places += apply_if_no_worse(&Finishing::reach_cut_parts, finishing, result);
    result.repairs.followed_creases += apply_if_no_worse(&Finishing::follow_creases, finishing, result);
    result.repairs.raised_places += apply_if_no_worse(&Finishing::raise_shapes, finishing, result);
    const int splits = apply_if_no_worse(&Finishing::split_folded, finishing, result);
    result.repairs.split_sides += splits;
    if (splits > 0) result.repairs.raised_places += apply_if_no_worse(&Finishing::raise_shapes, finishing, result);
    result.repairs.ended_searches += finishing.ended_searches();
  }
  result.repairs.opened_flat_quads += open_flat_quads(result.mesh, mean_edge_length(result.mesh), &whole_, least_agreement(whole_));
}

/// \returns what `means` counts; 0 where it broke the mesh, which then is as it was
int LastMeans::apply(Means means, const Finishing& finishing, ComponentResult& result) const {
  const RunContext improving = context_.in_stage("improve", 0.97, 0.97);
  const QuadMesh before = result.mesh;
  int count = 0;
  try {
    count = clock_.measure("improve", [&] { return (finishing.*means)(result.mesh, improving); });
    if (result.mesh.quads != before.quads) require_valid("improve", result.mesh, topology_of(planned_.mesh));
  } catch (const InternalError& error) {
    record_broken_promise(error, result.repairs, result.warnings);
    result.mesh = before;
    return 0;
  }
  if (count == 0) return 0;
  const Doubts doubts = finishing.doubts(result.mesh, context_.threads);
  result.flawed_quads = static_cast<int>(doubts.flawed.size());
  result.doubtful_quads = static_cast<int>(doubts.doubtful.size());
  return count;
}

/// They see to it that no more quads are in doubt; one that was may still have become flawed, which no shape is worth.
int LastMeans::apply_if_no_worse(Means means, const Finishing& finishing, ComponentResult& result) const {
  const QuadMesh before = result.mesh;
  const int flawed_before = result.flawed_quads, doubtful_before = result.doubtful_quads;
  const int count = apply(means, finishing, result);
  if (result.flawed_quads <= flawed_before) return count;
  result.mesh = before;
  result.flawed_quads = flawed_before;
  result.doubtful_quads = doubtful_before;
  return 0;
}

/// Passes without the features near flawed quads, marked ones neither, each from farther around; until one has none flawed, or work as much as the
/// last pass took is not left. It takes the result's place if it has fewer.
void LastMeans::let_marks_give_way(ComponentResult& result) {
  constexpr double kReaches[] = {0.3, 0.6, 1.2};  // of the edges that features need
  constexpr PassSettings kSettings{1.0, 1e-4, PassKind::kWithoutFeatures};
  constexpr int kMostToSplit = 12;
  std::vector<Vector3> places;
  for (const double reach : kReaches) {
    if (result.flawed_quads == 0) break;
    for (const int q : finishing().flawed(result.mesh, context_.threads)) places.push_back(middle_of(result.mesh, q));
    ComponentPlan plan = without_marks_at(planned_, places, reach, options_.symmetry.planes, context_);
    if (plan.marks_given_way == planned_.marks_given_way) continue;
    if (result.work > budget_.for_marks) {
      result.gave_up = true;
      break;
    }
    ++result.passes;
    try {
      ComponentResult other = run_pass(plan, whole_, wishes_, guides_, options_, kSettings, clock_, context_);
      budget_.for_marks -= other.work;
      settle_count(plan, count_, whole_, wishes_, options_, other, clock_, context_);
      if (other.flawed_quads <= kMostToSplit)
        LastMeans(plan, count_, whole_, wishes_, guides_, options_, budget_, clock_, context_).split_flawed(other);
      if (other.flawed_quads >= result.flawed_quads) {
        keep_broken_promises(other, result);
        continue;
      }
      other.passes = result.passes;
      keep_broken_promises(result, other);
      result = std::move(other);
      fewer_marks_ = std::move(plan);
    } catch (const InternalError& error) {
      record_broken_promise(error, result.repairs, result.warnings);
    }
  }
}

Finishing LastMeans::finishing() const { return Finishing(fewer_marks_ ? *fewer_marks_ : planned_, whole_, wishes_, options_); }

bool LastMeans::keeps_numbers() const { return !planned_.guides.empty(); }

}  // namespace hybrid_quad
