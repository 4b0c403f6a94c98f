#include "hybrid_quad/pipeline/first_pass.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/pipeline/broken_promises.h"
#include "hybrid_quad/pipeline/common_progress.h"
#include "hybrid_quad/pipeline/component_pass.h"

namespace hybrid_quad {

namespace {

double mean_shape(const QuadMesh& mesh) {
  double sum = 0;
  for (const auto& q : mesh.quads)
    sum += scaled_jacobian(mesh.positions[q[0]], mesh.positions[q[1]], mesh.positions[q[2]], mesh.positions[q[3]]);
  return sum / static_cast<double>(mesh.quads.size());
}

constexpr double kFailed = std::numeric_limits<double>::infinity();  ///< a distance

struct Trial {
  explicit Trial(ComponentPlan plan) : pass{std::move(plan), {}} {}

  FirstPass pass;
  std::optional<ComponentPass> begun;  ///< where there is only a sketch so far
  double shape = -1;                   ///< mean scaled Jacobian
  double quads = 0;
  double distance = kFailed;           ///< mean_distance_in_edges()
  std::optional<InternalError> error;  ///< instead of a result
  double curl_weight = PassSettings{}.curl_weight;
  double most_quads = 1.1;  ///< times the number

  /// A hundredth of an edge off the surface weighs as much as this many hundredths of the scaled Jacobian.
  static constexpr double kDistanceInShapes = 4;
  double score() const { return shape - kDistanceInShapes * distance; }
  double quads_for_each_wanted() const { return quads / pass.plan.quads; }
  bool has_far_too_many() const { return quads_for_each_wanted() > most_quads; }
};

/// Plans that differ in how many features by angle give way, the one with the fewest left first; the plan itself alone where hardly any are in
/// the way of others. \param very_many  receives whether the first goes without so many that quads are nearly always better off
std::vector<ComponentPlan> plans_to_try(const ComponentPlan& planned, PlaneSet mirror_planes, bool& very_many,
                                        const RunContext& context) {
  constexpr double kWorthATrial = 0.01, kFewest = 5;  // curves that give way, of the number of quads, and at least
  constexpr double kVeryMany = 0.12, kFewestOfThem = 30;
  std::vector<ComponentPlan> plans;
  ComponentPlan roomy = with_room_for_shapes(planned, mirror_planes, context);
  const int crowding = roomy.given_way - planned.given_way;
  very_many = crowding > std::max(kFewestOfThem, kVeryMany * planned.quads);
  if (crowding >= std::max(kFewest, kWorthATrial * planned.quads)) plans.push_back(std::move(roomy));
  plans.push_back(planned);
  if (planned.with_all) {
    plans.push_back(*planned.with_all);
    scale_plan(plans.back(), planned.quads / plans.back().quads);
  }
  return plans;
}

class FirstPasses {
 public:
  FirstPasses(const ComponentPlan& planned, const SurfaceIndex& whole, const Wishes& wishes, const HardGuides& guides,
              const RemeshOptions& options, StageClock& clock, ComponentResult& broken)
      : planned_(planned), whole_(whole), wishes_(wishes), guides_(guides), options_(options), clock_(clock), broken_(broken) {}

  /// The best of those that are good by their sketches, completed. Where very many features give way, only one pass without these is made, unless its quads have left
  /// the surface; where even the best has far more quads than wanted, one without any features by angle too.
  std::optional<Trial> with_fewer_or_all_features(const RunContext& context) {
    constexpr double kNear = 0.02;  // edges
    constexpr double kBetter = 0.02;  // has to be what goes without more features
    bool very_many = false;
    std::vector<Trial> trials;
    for (ComponentPlan& plan : plans_to_try(planned_, options_.symmetry.planes, very_many, context))
      trials.emplace_back(std::move(plan));
    const int count = static_cast<int>(trials.size());
    if (count == 1) return std::nullopt;
    const RunContext first = context.in_stage(context.stage, 0, kSketches), rest = context.in_stage(context.stage, kSketches, 1);
    if (very_many) {
      make_alone(trials[0], &FirstPasses::sketch, first.in_stage(context.stage, 0, 1.0 / count));
      if (trials[0].distance > kNear) make_side_by_side(all_but(trials, 1), &FirstPasses::sketch, first.in_stage(context.stage, 1.0 / count, 1));
    } else {
      make_side_by_side(all_but(trials, 0), &FirstPasses::sketch, first);
    }
    const std::unique_ptr<Trial> bare = without_features(best_of(trials, kBetter), first.in_stage(context.stage, 1, 1));
    if (bare) {
      make_alone(*bare, &FirstPasses::complete, rest);
      if (!bare->error) return std::move(*bare);
    }
    while (Trial* best = best_of(trials, kBetter)) {
      if (!best->begun) return std::move(*best);
      std::vector<Trial*> good;
      for (Trial& trial : trials)
        if (trial.begun && trial.score() >= best->score() - doubt()) good.push_back(&trial);
      make_side_by_side(good, &FirstPasses::complete, rest);
    }
    return std::nullopt;
  }

  /// \param first  the pass so far, if there is one
  /// \returns the best of it and of others, where there are thin parts and quads end short of the surface (docs/decisions/0052, 0053)
  std::optional<Trial> with_room_for_thin_parts(std::optional<Trial> first, const RunContext& context) {
    constexpr double kEven = 0.9, kNotCrowded = 0.7;  // shapes
    const bool has_thin_parts = !planned_.thin_places->empty();
    if (!has_thin_parts && !is_wire(*planned_.index, planned_.length, context)) return first;
    if (!first) {
      first.emplace(planned_);
      make_alone(*first, &FirstPasses::complete, context.in_stage(context.stage, 0, 0.5));
    }
    double farthest = largest_distance_in_edges(*first, context.in_stage("quality", 0.5, 0.5));
    const double shape = first->shape;
    if (farthest <= kFar && shape >= kEven && first->quads_for_each_wanted() <= kHeld) return first;
    const ComponentPlan plan = first->pass.plan;
    const ThinTubes tubes = thin_tubes(*plan.index, plan.length, context);
    if (is_wire(tubes)) {
      const bool is_lost = farthest > kFar || first->quads_for_each_wanted() > kHeld;
      std::vector<Trial> longer = with_parts_longer(plan, tubes, is_lost ? 2 : 1, context);
      if (take_nearer(*first, farthest, std::move(longer), context.in_stage(context.stage, 0.5, 0.7))) return first;
    }
    if (farthest <= kFar || !has_thin_parts || first->quads_for_each_wanted() > kHeld) return first;
    take_nearer(*first, farthest, with_parts_shorter(plan, context), context.in_stage(context.stage, 0.7, 0.9));
    if (!is_wire(tubes) && farthest > kFar && shape > kNotCrowded)
      take_nearer(*first, farthest, with_parts_longer(plan, tubes, 2, context), context.in_stage(context.stage, 0.9, 1));
    return first;
  }

 private:
  using Make = void (FirstPasses::*)(Trial&, StageClock&, const RunContext&) const;

  /// Where features by angle hold far more quads than there are to be, a sketch without any, if that is far nearer to the number.
  /// \param best  with features; null: none has a result
  std::unique_ptr<Trial> without_features(const Trial* best, const RunContext& context) {
    constexpr double kHeldByFeatures = 1.5, kFewer = 0.75;
    if (best == nullptr || !options_.is_by_count() || best->quads_for_each_wanted() < kHeldByFeatures) return nullptr;
    auto bare = std::make_unique<Trial>(without_features_by_angle(planned_, options_.symmetry.planes, context));
    if (bare->pass.plan.given_way <= best->pass.plan.given_way) return nullptr;
    make_alone(*bare, &FirstPasses::sketch, context);
    if (bare->error || bare->quads_for_each_wanted() > kFewer * best->quads_for_each_wanted()) return nullptr;
    return bare;
  }

  static constexpr double kSketches = 0.4;  ///< of the time
  static constexpr double kHeld = 1.8;  ///< times the number: where features hold so many quads, parts have no room for more
  static constexpr double kFar = 1.25;  ///< edges: parts are lost
  static constexpr double kFirm =
      1e-3;  ///< curl weight; else sizes give way to integrable frames, and two quads go around where four were planned
  static constexpr double kMany = 1.3;  ///< times the quads, which can be settled; a lost limb can't

  std::vector<Trial> with_parts_shorter(const ComponentPlan& plan, const RunContext& context) const {
    constexpr double kGrowths[] = {1.5, 2.5};
    std::vector<Trial> trials;
    for (const double growth : kGrowths) {
      Trial trial(hybrid_quad::with_room_for_thin_parts(plan, growth, options_.is_by_count(), context));
      if (!trials.empty() && trials.back().pass.plan.thin_ratio == trial.pass.plan.thin_ratio) continue;
      trial.curl_weight = kFirm;
      trial.most_quads = kMany;
      trials.push_back(std::move(trial));
    }
    return trials;
  }

  /// None where others say how long quads are to be, or how much longer than wide.
  std::vector<Trial> with_parts_longer(const ComponentPlan& plan, const ThinTubes& tubes, int most,
                                       const RunContext& context) const {
    constexpr double kGrowths[] = {1.5, 1.0};
    std::vector<Trial> trials;
    constexpr double kFewest = 16;  // four rings
    constexpr double kMost = 4000;  // with more, what is lost is small, and passes take long
    if (plan.quads < kFewest || plan.quads > kMost) return trials;
    if (options_.anisotropy > 1 || !wishes_.corner_frames.empty() || !wishes_.density.empty()) return trials;
    for (const double growth : kGrowths) {
      if (static_cast<int>(trials.size()) == most) break;
      std::optional<ComponentPlan> long_quads = with_long_quads(plan, tubes, growth, options_.is_by_count(), context);
      if (!long_quads || (!trials.empty() && trials.back().pass.plan.target == long_quads->target)) continue;
      Trial& trial = trials.emplace_back(*std::move(long_quads));
      trial.curl_weight = kFirm;
      trial.most_quads = kMany;
    }
    return trials;
  }

  /// Makes passes, and keeps the best of them and of the one so far, of which the surface is nowhere as far.
  /// \param farthest  of the one so far, in edges; gets that of the best  \returns whether it is another
  bool take_nearer(Trial& so_far, double& farthest, std::vector<Trial> others, const RunContext& context) {
    constexpr double kNearer = 0.8;
    make_side_by_side(all_but(others, 0), &FirstPasses::complete, context);
    const double enough = farthest > kFar ? kNearer * farthest : kFar;
    const auto distance = [&](const Trial& trial) { return largest_distance_in_edges(trial, context.in_stage("quality", 1, 1)); };
    std::vector<Trial> trials;
    trials.push_back(std::move(so_far));
    for (Trial& other : others)
      if (distance(other) <= enough) trials.push_back(std::move(other));
    // What far too many quads show is lost with them.
    const bool is_vain = !trials[0].error && trials[0].quads_for_each_wanted() > kHeld;
    Trial* best = best_of(trials, 0);
    for (Trial& trial : trials)
      if (is_vain && best == trials.data() && !trial.error && !trial.has_far_too_many()) best = &trial;
    const bool is_other = best != nullptr && best != trials.data();
    so_far = std::move(is_other ? *best : trials.front());
    if (is_other) farthest = distance(so_far);
    return is_other;
  }

  double largest_distance_in_edges(const Trial& trial, const RunContext& context) const {
    return trial.error ? kFailed : farthest_from_quads(planned_.mesh, trial.pass.result.mesh, context).edges;
  }

  /// How much a score may change from a sketch to the whole pass: of few quads, which cost little, more.
  double doubt() const {
    constexpr double kFew = 1000, kOfFew = 0.15, kOfMany = 0.05;
    return planned_.quads < kFew ? kOfFew : kOfMany;
  }

  static std::vector<Trial*> all_but(std::vector<Trial>& trials, int first) {
    std::vector<Trial*> rest;
    for (auto trial = trials.begin() + first; trial != trials.end(); ++trial) rest.push_back(&*trial);
    return rest;
  }

  /// \param how  sketch or complete
  void make_side_by_side(const std::vector<Trial*>& trials, Make how, const RunContext& context) {
    const int count = static_cast<int>(trials.size());
    std::vector<StageClock> clocks(count);
    CommonProgress progress(context, std::vector<double>(count, 1.0 / count), 0, 1);
    side_by_side(count, context,
                 [&](int i, const RunContext& each) { (this->*how)(*trials[i], clocks[i], progress.context_of(i, each)); });
    for (const StageClock& one : clocks) clock_.add(one);
    for (const Trial* trial : trials) note(*trial);
  }

  void make_alone(Trial& trial, Make how, const RunContext& context) {
    (this->*how)(trial, clock_, context);
    note(trial);
  }

  void note(const Trial& trial) {
    if (trial.error) record_broken_promise(*trial.error, broken_.repairs, broken_.warnings);
  }

  ComponentPass pass_of(const Trial& trial) const {
    PassSettings settings;
    settings.curl_weight = trial.curl_weight;
    settings.is_doubtful = trial.pass.plan.given_way < planned_.given_way;
    return {trial.pass.plan, whole_, wishes_, guides_, options_, settings};
  }

  /// \pre the trial does not move before it is completed
  void sketch(Trial& trial, StageClock& clock, const RunContext& context) const {
    attempt(trial, context, [&]() -> const QuadMesh& { return trial.begun.emplace(pass_of(trial)).sketch(clock, context); });
  }

  void complete(Trial& trial, StageClock& clock, const RunContext& context) const {
    attempt(trial, context, [&]() -> const QuadMesh& {
      if (!trial.begun) trial.begun.emplace(pass_of(trial));
      trial.pass.result = trial.begun->complete(clock, context);
      trial.begun.reset();
      return trial.pass.result.mesh;
    });
  }

  /// Measures the quads that `make` gives.
  template <class MakeQuads>
  void attempt(Trial& trial, const RunContext& context, const MakeQuads& make) const {
    try {
      const QuadMesh& quads = make();
      trial.shape = mean_shape(quads);
      trial.quads = static_cast<double>(quads.quads.size());
      trial.distance = mean_distance_in_edges(quads, *planned_.index, context.in_stage("quality", 1, 1));
    } catch (const InternalError& error) {
      trial.error = error;
      trial.shape = -1;
      trial.distance = kFailed;
    }
  }

  /// \param allowance  of the score, for each that comes later
  /// \returns null where none has a result
  static Trial* best_of(std::vector<Trial>& trials, double allowance) {
    Trial* best = nullptr;
    for (Trial& trial : trials)
      if (!trial.error && (!best || (trial.score() >= best->score() - allowance && !trial.has_far_too_many()))) best = &trial;
    return best;
  }

  const ComponentPlan& planned_;
  const SurfaceIndex& whole_;
  const Wishes& wishes_;
  const HardGuides& guides_;
  const RemeshOptions& options_;
  StageClock& clock_;
  ComponentResult& broken_;
};

}  // namespace

std::optional<FirstPass> first_pass_by_trial(const ComponentPlan& planned, const SurfaceIndex& whole, const Wishes& wishes,
                                             const HardGuides& guides, const RemeshOptions& options, StageClock& clock,
                                             const RunContext& context, ComponentResult& broken) {
  if (!options.improve || !planned.guides.empty()) return std::nullopt;
  FirstPasses passes(planned, whole, wishes, guides, options, clock, broken);
  std::optional<Trial> best = passes.with_fewer_or_all_features(context.in_stage(context.stage, 0, 0.8));
  best = passes.with_room_for_thin_parts(std::move(best), context.in_stage(context.stage, best ? 0.8 : 0, 0.9));
  return best && !best->error ? std::optional(std::move(best->pass)) : std::nullopt;
}

}  // namespace hybrid_quad
