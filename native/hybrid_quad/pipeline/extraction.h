#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/spanning_parameterization/spanning_parameterization.h"

namespace hybrid_quad {

/// The quads of one try to remesh a component, and how they came about.
struct Extraction {
  QuadMesh mesh;
  SpanningParameterization param;
  int patch_count = 0, combinatorial_count = 0;
  double singular_area = 0, combinatorial_area = 0;
  RepairRecord repairs;
  FeatureGraph features;     ///< whose curves the feature edges are on, where some became rings
  std::vector<GuideEdge> rings, chains;
  double quads_before_rows = 0;  ///< before rows were split or taken out for the number
  int flawed = 0;            ///< quads, after improvement
  int missed = 0;            ///< missed_counts()
  double count_error = 0;    ///< | log(count / asked) |, after improvement
  std::optional<double> distance;  ///< mean_distance_in_edges(), where it was to be compared

  double count() const { return static_cast<double>(mesh.quads.size()); }
};

/// Of several tries, the one to go on with: the one with the fewest flaws, then the one nearest to the number asked for; but a lost limb,
/// a few hundredths of an edge length in the mean, is worse than a few hundredths of the number, which can be settled afterwards.
class ExtractionChoice {
 public:
  using Distance = std::function<double(const QuadMesh&)>;
  /// \param distance  of quads from the surface, in the mean, in edge lengths: measured once there is something to compare
  /// \param tolerance  of the logarithm of the number
  /// \param enough_with_flaws  so many tries near the number, with flaws, are enough
  /// \param far  so far off (tolerance) improving makes no sense
  ExtractionChoice(double quads_asked, double tolerance, int enough_with_flaws, double far, Distance distance)
      : asked_(quads_asked), tolerance_(tolerance), far_(far), enough_(enough_with_flaws), distance_(std::move(distance)) {}

  bool any() const { return best_.has_value(); }
  /// How many times as many quads as in the end have to be extracted: improvement takes some.
  double lost() const { return lost_; }
  /// So far off that improving it makes no sense, unless it is all there is.
  bool is_far(const Extraction& e) const { return error(e) >= far_; }
  void set_aside(Extraction e) {
    if (!nearest_ || error(e) < error(*nearest_)) nearest_ = std::move(e);
  }
  Extraction nearest_set_aside() { return std::move(*nearest_); }

  /// \param extracted  quads of e before improvement
  void take(Extraction e, double extracted) {
    lost_ = extracted / e.count();
    e.count_error = error_of(e.count());
    const bool is_near = e.count_error < tolerance_;
    near_with_flaws_ += is_near && e.flawed > 0;
    if (!best_ || is_better(e, *best_)) best_ = std::move(e);
    is_done_ = (is_near && best_->flawed == 0) || near_with_flaws_ >= enough_;
  }
  bool is_done() const { return is_done_; }
  /// Whether only flawed quads keep e from being the one to go on with, and all tries from ending.
  bool lacks_only_soundness(const Extraction& e) const {
    return best_ && best_->flawed == 0 && e.flawed > 0 && e.missed <= best_->missed && error_of(e.count()) < tolerance_;
  }
  Extraction best() { return std::move(*best_); }

 private:
  bool is_better(Extraction& one, Extraction& other) const {
    const auto soundness = [](const Extraction& x) { return std::make_pair(x.flawed, x.missed); };
    if (soundness(one) != soundness(other)) return soundness(one) < soundness(other);
    for (Extraction* x : {&one, &other})
      if (!x->distance) x->distance = distance_(x->mesh);
    constexpr double kDistance = 3;  // an edge length weighs as much as so many times the number
    return one.count_error + kDistance * *one.distance < other.count_error + kDistance * *other.distance;
  }
  double error_of(double count) const { return std::abs(std::log(count / asked_)); }
  double error(const Extraction& e) const { return error_of(e.count() / lost_); }

  double asked_, tolerance_, far_;
  int enough_;
  Distance distance_;
  double lost_ = 1;
  int near_with_flaws_ = 0;
  bool is_done_ = false;
  std::optional<Extraction> best_, nearest_;
};

}  // namespace hybrid_quad
