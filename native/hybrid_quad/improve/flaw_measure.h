#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

/// How flawed (quality.h) some quads are together, as a Trial::Measure: what counts is the very property that a judge checks.
class FlawMeasure {
 public:
  /// \param whole, agreement  the surface to measure by, and the other parameter of flawed_quads
  /// \param least  what is flawed beyond doubt, as flaws() counts it; null: all that is flawed is
  FlawMeasure(const Workpiece& piece, const SurfaceIndex& whole, const Agreement& agreement, const Agreement* least = nullptr)
      : piece_(piece), whole_(whole), agreement_(agreement), least_(least) {}

  bool is_flawed(int q) const { return flaws(q) > 0; }

  /// 0, 1 for a quad that may be flawed, or more than many of these for one that is beyond doubt.
  int flaws(int q) const {
    constexpr int kBeyondDoubt = 1000;
    constexpr double kLeastArea = 1e-9;
    const std::array<Vector3, 4> p = corners(q);
    if (q >= static_cast<int>(known_.size())) {
      known_.resize(q + 1);
      lookup_.resize(q + 1);
    }
    std::array<Known, 2>& known = known_[q];
    if (known[0].corners == p) return known[0].flaws;
    std::swap(known[0], known[1]);
    if (known[0].corners == p) return known[0].flaws;
    const double least_area = kLeastArea * piece_.h * piece_.h;
    known[0] = {p, hybrid_quad::is_flawed(p, least_area, whole_, agreement_, &lookup_[q])};
    if (known[0].flaws > 0 && (!least_ || hybrid_quad::is_flawed(p, least_area, whole_, *least_, &lookup_[q])))
      known[0].flaws = kBeyondDoubt;
    return known[0].flaws;
  }

  /// Learns of all quads, on all threads, which of them are flawed.
  void look_at_all(const RunContext& context) const {
    known_.resize(piece_.mesh.quad_count());
    lookup_.resize(piece_.mesh.quad_count());
    parallel_chunks(piece_.mesh.quad_count(), context, [&](int begin, int end) {
      for (int q = begin; q < end; ++q)
        if (piece_.mesh.alive(q)) is_flawed(q);
    });
  }

  /// What a quad's scaled Jacobian lacks to a fair one.
  double lacks_shape(int q) const {
    const std::array<Vector3, 4> p = corners(q);
    return std::max(0.0, kFair - scaled_jacobian(p[0], p[1], p[2], p[3]));
  }

  /// Minus the number of flawed ones; bad shapes together make a difference below kMostForShapes.
  double operator()(const std::vector<int>& quads) const {
    double flawed = 0, bad = 0;
    for (const int q : quads) {
      flawed += is_flawed(q);
      bad += lacks_shape(q);
    }
    return -flawed - kMostForShapes * bad / (1 + bad);
  }
  const SurfaceIndex& surface() const { return whole_; }

  /// Of the surface's tree, by all looks so far: a measure of work.
  long long boxes_opened() const {
    long long sum = 0;
    for (const Lookup& lookup : lookup_) sum += lookup.boxes_opened;
    return sum;
  }

  static constexpr double kFair = 0.2;
  static constexpr double kMostForShapes = 0.4;

 private:
  std::array<Vector3, 4> corners(int q) const {
    const auto& v = piece_.mesh.quad(q);
    const auto& p = piece_.mesh.positions;
    return {p[v[0]], p[v[1]], p[v[2]], p[v[3]]};
  }

  /// Of a quad with its corners there: many trials in turn begin, and when they fail end, at the same quads.
  struct Known {
    std::array<Vector3, 4> corners{Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
    int flaws = 1;  ///< so it is where all corners are at the origin
  };

  const Workpiece& piece_;
  const SurfaceIndex& whole_;
  Agreement agreement_;
  const Agreement* least_;
  mutable std::vector<std::array<Known, 2>> known_;  ///< the latest first
  mutable std::vector<Lookup> lookup_;               ///< #Q: of where the quad was last
};

}  // namespace hybrid_quad
