#include "hybrid_quad/pipeline/settle_count.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "hybrid_quad/assemble/feature_chains.h"
#include "hybrid_quad/mesh/quad_count.h"
#include "hybrid_quad/mesh/topology.h"
#include "hybrid_quad/pipeline/broken_promises.h"
#include "hybrid_quad/pipeline/curve_counts.h"
#include "hybrid_quad/pipeline/finishing.h"

namespace hybrid_quad {

namespace {

constexpr double kNear = 0.045;   ///< of the logarithm of the number: off by less is left as it is
constexpr double kAim = 0.02;     ///< of the number
constexpr double kLeastGain = 1e-9;
constexpr int kRowRounds = 2, kRounds = 6;
/// Improving takes longer than all else, most of all where it is in vain.
constexpr int kMostImprovements = 6;
constexpr std::size_t kFewFlawed = 4;  ///< sides are split for no more: where improving leaves many, the number is out of reach

double error_of(double quads, double wanted) { return std::abs(std::log(quads / wanted)); }
bool is_far_off(double quads, double wanted) { return error_of(quads, wanted) > kNear && std::abs(quads - wanted) > 1; }

class CountSettling {
 public:
  CountSettling(const ComponentPlan& plan, double wanted, const Finishing& finishing, const SurfaceIndex& whole,
                ComponentResult& result, const RunContext& context)
      : plan_(plan), wanted_(wanted), finishing_(finishing), whole_(whole), result_(result), context_(context),
        now_(measured(result.mesh)), error_at_first_(now_.error) {
    for (const FeatureCurve& curve : plan.features.curves) counted_.push_back(curve.asked_count > 0);
  }

  void run() {
    try {
      settle();
    } catch (const InternalError& error) {
      record_broken_promise(error, result_.repairs, result_.warnings);  // what was taken before is valid
    }
    if (!any_taken_) return;
    result_.repairs.fitted_rows += rows_;
    result_.flawed_quads = now_.flawed;
    result_.doubtful_quads = now_.doubtful;
    result_.missed_counts = now_.missed;
  }

 private:
  SettledState measured(const QuadMesh& mesh) const {
    const int quads = static_cast<int>(mesh.quads.size());
    const Doubts doubts = finishing_.doubts(mesh, context_.threads);
    return {quads, static_cast<int>(doubts.flawed.size()), static_cast<int>(doubts.doubtful.size()),
            missed_counts(plan_.features, mesh), error_of(quads, wanted_)};
  }

  void settle() {
    for (int i = 0, last = -1; i < kRowRounds && is_far() && rows_ != last && may_improve(); ++i) {
      last = rows_;
      rows_ += change_rows();
    }
    bool is_rough = false;
    for (int i = 0; i < kRounds && is_far() && change_quads(); ++i) is_rough = true;
    if (is_rough) improve_again();
  }

  bool is_far() const { return is_far_off(now_.quads, wanted_); }
  double tolerance() const { return std::max(1.0, kAim * wanted_); }

  /// \returns whether `mesh` is sound and no worse; then it is the result
  bool take(QuadMesh mesh, double most_error) {
    if (!violations_of(mesh).empty() || topology_of(mesh) != topology_of(plan_.mesh)) return false;
    const SettledState then = measured(mesh);
    if (!may_take_place_of(then, now_, most_error, error_at_first_)) return false;
    now_ = then;
    any_taken_ = true;
    result_.mesh = std::move(mesh);
    return true;
  }
  bool take_if_nearer(QuadMesh mesh) { return take(std::move(mesh), now_.error - kLeastGain); }

  /// \returns rows changed
  int change_rows() {
    QuadComplex complex = complex_of(result_.mesh);
    const int rows = fit_quad_count(complex, wanted_, tolerance(), counted_, context_);
    if (rows == 0 || !is_worth_improving(error_of(complex.quad_count(), wanted_), now_.error)) return 0;
    QuadMesh mesh = to_quad_mesh(complex);
    order_feature_edges(mesh, plan_.mesh, plan_.features);
    return take_if_nearer(improved(std::move(mesh))) ? rows : 0;
  }

  /// \returns whether the number is nearer
  bool change_quads() {
    // Where all that is missing is too much at once, half of it may do.
    constexpr int kHalvings = 5;
    int target = static_cast<int>(std::lround(wanted_));
    for (int i = 0; i < kHalvings; ++i) {
      QuadMesh bare = result_.mesh;
      const int changed = change_quad_number(bare, plan_.mesh, plan_.features, *plan_.index, finishing_.options(),
                                             {target, plan_.target}, context_, &whole_);
      if (changed == 0) return false;
      target = now_.quads + changed / 2;
      finishing_.make_mirrorable(bare, context_);
      const bool is_worth_it = is_worth_improving(error_of(static_cast<double>(bare.quads.size()), wanted_), now_.error);
      if (take_if_nearer(bare) || (is_worth_it && may_improve() && take_if_nearer(improved(std::move(bare))))) {
        result_.repairs.fitted_quads += std::abs(changed);
        return true;
      }
      if (!is_worth_it) return false;  // nor is a half of it
    }
    return false;
  }

  bool may_improve() const { return improvements_ < kMostImprovements; }

  QuadMesh improved(QuadMesh mesh) {
    ++improvements_;
    finishing_.improve(mesh, context_);
    const std::size_t flawed = finishing_.flawed(mesh, context_.threads).size();
    if (flawed > 0 && flawed <= kFewFlawed)
      result_.repairs.split_sides += finishing_.split_flawed(mesh, context_);
    finishing_.make_mirrorable(mesh, context_);
    return mesh;
  }

  /// Shapes and valences, as long as the number stays near.
  void improve_again() { take(improved(result_.mesh), std::max(kNear, now_.error)); }

  const ComponentPlan& plan_;
  double wanted_;  ///< quads
  const Finishing& finishing_;
  const SurfaceIndex& whole_;
  ComponentResult& result_;
  const RunContext& context_;
  std::vector<char> counted_;
  int improvements_ = 0, rows_ = 0;  ///< of quads that were changed
  SettledState now_;
  double error_at_first_;
  bool any_taken_ = false;
};

}  // namespace

bool may_take_place_of(const SettledState& then, const SettledState& now, double most_error, double error_at_first) {
  if (then.flawed > now.flawed || then.doubtful > now.doubtful || then.missed > now.missed) return false;
  return then.error <= (then.flawed < now.flawed ? std::max(most_error, error_at_first) : most_error);
}

bool is_worth_improving(double error_then, double error_now) {
  constexpr double kWorth = 0.1;
  return error_then <= (1 - kWorth) * error_now;
}

void settle_count(const ComponentPlan& plan, double wanted, const SurfaceIndex& whole, const Wishes& wishes,
                  const RemeshOptions& options, ComponentResult& result, StageClock& clock, const RunContext& context) {
  if (!options.improve || !plan.guides.empty() || wishes.most_stretch > 1) return;
  clock.measure("count", [&] {
    if (!is_far_off(static_cast<double>(result.mesh.quads.size()), wanted)) return;
    const Finishing finishing(plan, whole, wishes, options);
    CountSettling(plan, wanted, finishing, whole, result, context.in_stage("count", 0.97, 0.97)).run();
  });
}

}  // namespace hybrid_quad
