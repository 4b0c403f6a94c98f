#include "hybrid_quad/pipeline/remesh_components.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/pipeline/common_progress.h"
#include "hybrid_quad/pipeline/count_budget.h"
#include "hybrid_quad/pipeline/finishing.h"
#include "hybrid_quad/pipeline/split_triangles.h"

namespace hybrid_quad {

namespace {

constexpr double kLeastOfPlan = 0.5;  // no component pays with all its shape for what others cost

/// Of a WorkBudget, of which one component takes half: that is about a quarter of a minute, and another for ten thousand quads.
constexpr double kExtraWork = 2.5e5, kExtraWorkPerQuad = 20;
constexpr double kWorkForMarks = 0.1;  // as much besides

/// What one component of a wave is asked for and gives. Its budget is the wave's, as if it were alone there.
struct Job {
  int component;
  double planned, wanted;
  WorkBudget budget;
  StageClock clock;
  ComponentResult result;
};

/// Quads of a small component can have an area beside the component's other quads, and none beside all.
void open_flat_quads_of(std::vector<ComponentResult>& parts, const SurfaceIndex& whole, int threads) {
  double length = 0, quads = 0;
  for (const ComponentResult& part : parts) {
    const double count = static_cast<double>(part.mesh.quads.size());
    length += count * mean_edge_length(part.mesh);
    quads += count;
  }
  for (ComponentResult& part : parts) {
    const int opened = open_flat_quads(part.mesh, length / quads, &whole, least_agreement(whole));
    part.repairs.opened_flat_quads += opened;
    if (opened > 0) part.flawed_quads = static_cast<int>(flawed_quads(part.mesh, whole, least_agreement(whole), threads).size());
  }
}

}  // namespace

std::vector<std::vector<int>> component_waves(const std::vector<ComponentPlan>& plans) {
  std::vector<int> order(plans.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return plans[a].quads < plans[b].quads; });
  double left = 0;
  for (const ComponentPlan& plan : plans) left += plan.quads;
  std::vector<std::vector<int>> waves;
  for (std::size_t i = 0; i < order.size();) {
    std::vector<int> wave;
    double quads = 0;
    do {
      quads += plans[order[i]].quads;
      wave.push_back(order[i++]);
    } while (i < order.size() && quads + plans[order[i]].quads <= 0.5 * left);
    left -= quads;
    waves.push_back(std::move(wave));
  }
  return waves;
}

std::vector<ComponentResult> remesh_components(RunPlan& run, const SurfaceIndex& whole, StageClock& clock) {
  std::vector<ComponentResult> parts(run.components.size());
  CountBudget budget(run.plans, run.options.is_by_count() ? run.wanted / run.images : 0);
  const double extra = kExtraWork + kExtraWorkPerQuad * run.wanted;
  WorkBudget work{extra, kWorkForMarks * extra};
  CommonProgress progress(run.context, shares_of_area(run), 0.04, 0.97);
  for (const std::vector<int>& wave : component_waves(run.plans)) {
    std::vector<Job> jobs;
    for (auto i = wave.rbegin(); i != wave.rend(); ++i) {  // the largest first, that none is left to run alone
      ComponentPlan& plan = run.plans[*i];
      const double planned = plan.quads;
      if (run.options.is_by_count()) scale_plan(plan, budget.factor());
      const double wanted = run.options.is_by_count() ? std::max(budget.share(planned), kLeastOfPlan * plan.quads) : planned;
      jobs.push_back({*i, planned, wanted, work, {}, {}});
    }
    side_by_side(static_cast<int>(jobs.size()), run.context, [&](int j, const RunContext& each) {
      Job& job = jobs[j];
      const int i = job.component;
      job.result = remesh_component(run.plans[i], job.wanted, whole, run.wishes[i], run.guides, run.domain.options, job.budget,
                                    job.clock, progress.context_of(i, each));
      if (job.result.flawed_quads > 0)
        keep_triangles(run.components[i].mesh, run.plans[i], job.wanted, whole, each.threads, job.result);
    });
    const WorkBudget before = work;
    for (Job& job : jobs) {
      clock.add(job.clock);
      work.left -= before.left - job.budget.left;
      work.for_marks -= before.for_marks - job.budget.for_marks;
      budget.spend(job.planned, static_cast<double>(job.result.mesh.quads.size()));
      parts[job.component] = std::move(job.result);
    }
  }
  open_flat_quads_of(parts, whole, run.context.threads);
  return parts;
}

}  // namespace hybrid_quad
