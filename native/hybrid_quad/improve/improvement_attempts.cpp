#include "hybrid_quad/improve/improvement_attempts.h"

#include <algorithm>
#include <utility>

#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

constexpr int kFewFlawed = 3;

/// Whether to improve again, with what is extracted around `flawed` quads as it is. That helps where few are; many, in
/// many places, are taken up by splits and by other passes.
bool is_worth_another_attempt(int flawed, std::size_t quads) {
  constexpr std::size_t kQuick = 1000;
  return flawed > 0 && (flawed <= kFewFlawed || quads <= kQuick);
}

/// Mean length of the edges at each vertex.
std::vector<double> edge_lengths_at(const QuadMesh& mesh) {
  std::vector<double> sum(mesh.positions.size(), 0), count(mesh.positions.size(), 0);
  for (const auto& q : mesh.quads)
    for (int k = 0; k < 4; ++k) {
      const double length = (mesh.positions[q[(k + 1) & 3]] - mesh.positions[q[k]]).norm();
      for (const int v : {q[k], q[(k + 1) & 3]}) {
        sum[v] += length;
        count[v] += 1;
      }
    }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= std::max(1.0, count[v]);
  return sum;
}

/// Vertices of the extracted quads, which are on the surface, that the improved quads have left: limbs hardly wider than quads get better
/// shapes where they are wider.
std::vector<int> left_vertices(const QuadMesh& extracted, const QuadMesh& improved, const RunContext& context) {
  constexpr double kFar = 0.5;  // in edges
  const std::vector<SurfacePoint> nearest = nearest_on_quads(extracted.positions, improved, context);
  const std::vector<double> length = edge_lengths_at(extracted);
  std::vector<int> left;
  for (std::size_t v = 0; v < nearest.size(); ++v)
    if (nearest[v].squared_distance > kFar * kFar * length[v] * length[v]) left.push_back(static_cast<int>(v));
  return left;
}

}  // namespace

ImprovementAttempts::ImprovementAttempts(const QuadMesh& extracted, const SurfaceIndex& index, const SurfaceIndex& judged,
                                         const Agreement& agreement, const RunContext& context, Round round)
    : extracted_(extracted), index_(index), judged_(judged), agreement_(agreement), context_(context), round_(std::move(round)) {}

int ImprovementAttempts::flawed_before() { return restoration().flawed_count(); }

Improved ImprovementAttempts::once() { return attempt(); }

Improved ImprovementAttempts::best(std::optional<Improved> first) {
  Improved best = with_fewest_flaws(std::move(first));
  return_to_surface(best);
  // Quads that tips hold may be in each other's way: where nothing else helps none are held.
  if (best.report.flawed_after > 0 && !best.tips.empty()) {
    released_ = best.tips;
    Improved now = with_fewest_flaws(std::nullopt);
    if (now.report.flawed_after <= best.report.flawed_after) best = std::move(now);
  }
  return best;
}

/// Only where something is spoilt does it matter what was before.
Restoration& ImprovementAttempts::restoration() {
  if (!restoration_) restoration_.emplace(extracted_, judged_, agreement_, context_.threads);
  return *restoration_;
}

Improved ImprovementAttempts::attempt() {
  const std::vector<char> locked = restoration_ ? restoration_->locked() : std::vector<char>(extracted_.quads.size(), 0);
  Improved now = round_(locked, released_);
  now.flawed = flawed_quads(now.quads, judged_, agreement_, context_.threads);
  now.report.flawed_after = static_cast<int>(now.flawed.size());
  now.report.restored_quads = restoration_ ? restoration_->locked_count() : 0;
  now.report.released_tips = released_.empty() ? 0 : 1;
  return now;
}

/// Of some attempts, each with more of what was extracted around flawed quads: as long as that helps, and a few times anyway before tips
/// have to let go.
Improved ImprovementAttempts::with_fewest_flaws(std::optional<Improved> first) {
  constexpr int kAttempts = 5;
  restoration_.reset();
  Improved latest = first ? *std::move(first) : attempt(), best = latest;
  for (int i = 1; i < kAttempts && is_worth_another_attempt(best.report.flawed_after, best.quads.quads.size()); ++i) {
    if (!restoration().give_up_around(latest.quads, latest.flawed)) break;
    latest = attempt();
    const bool is_better = latest.report.flawed_after < best.report.flawed_after;
    if (is_better) best = latest;
    if (!is_better && (best.tips.empty() || best.report.flawed_after > kFewFlawed)) break;
  }
  return best;
}

/// With what was extracted where quads have left the surface, as long as that brings them nearer (docs/decisions/0051).
void ImprovementAttempts::return_to_surface(Improved& best) {
  constexpr int kRounds = 3;
  constexpr double kWorthwhile = 0.002;  // of the vertices
  double distance = -1;
  for (int i = 0; i < kRounds && best.report.flawed_after <= kFewFlawed; ++i) {
    const std::vector<int> left = left_vertices(extracted_, best.quads, context_);
    if (left.size() <= kWorthwhile * static_cast<double>(extracted_.positions.size()) || !restoration().give_up_at(extracted_, left))
      return;
    if (distance < 0) distance = mean_distance_in_edges(best.quads, index_, context_);
    Improved now = attempt();
    const double distance_now = mean_distance_in_edges(now.quads, index_, context_);
    if (now.report.flawed_after > best.report.flawed_after || distance_now >= distance) return;
    best = std::move(now);
    distance = distance_now;
  }
}

}  // namespace hybrid_quad
