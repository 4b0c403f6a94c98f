#include "hybrid_quad/improve/curve_geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hybrid_quad {

CurveGeometry::CurveGeometry(std::vector<Vector3> points, bool closed) : points_(std::move(points)), closed_(closed) {
  if (points_.empty()) points_.push_back(Vector3::Zero());
  if (points_.size() == 1) points_.push_back(points_[0]);
  arc_.assign(points_.size(), 0.0);
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) arc_[i + 1] = arc_[i] + (points_[i + 1] - points_[i]).norm();
  weighted_ = arc_;
}

double CurveGeometry::normalized(double s) const {
  const double total = length();
  if (!closed_) return std::min(total, std::max(0.0, s));
  if (s >= 0 && s < total) return s;
  if (!(total > 0)) return 0;
  s = std::fmod(s, total);
  return s < 0 ? s + total : s;
}

int CurveGeometry::segment_at(double s) const {
  const int i = static_cast<int>(std::upper_bound(arc_.begin(), arc_.end(), s) - arc_.begin()) - 1;
  return std::max(0, std::min(i, static_cast<int>(points_.size()) - 2));
}

Vector3 CurveGeometry::at(double s) const {
  s = normalized(s);
  const int i = segment_at(s);
  const double span = arc_[i + 1] - arc_[i];
  if (!(span > 0)) return points_[i];
  return points_[i] + ((s - arc_[i]) / span) * (points_[i + 1] - points_[i]);
}

Vector3 CurveGeometry::tangent(double s) const {
  const double reach = 1e-6 * length();
  const double low = closed_ ? s - reach : std::max(0.0, s - reach), high = closed_ ? s + reach : std::min(length(), s + reach);
  const Vector3 along = at(high) - at(low);
  const double size = along.norm();
  return size > 0 ? Vector3(along / size) : Vector3(Vector3::Zero());
}

double CurveGeometry::turning(double from, double to) const {
  const Vector3 middle = at((from + to) / 2);
  const Vector3 before = middle - at(from), after = at(to) - middle;
  const double size = before.norm() * after.norm();
  return size > 0 ? std::acos(std::min(1.0, std::max(-1.0, before.dot(after) / size))) : 0.0;
}

CurveGeometry CurveGeometry::with_cut_corners(double reach) const {
  constexpr double kShare = 0.25;
  CurveGeometry cut = *this;
  cut.points_.clear();
  cut.arc_.clear();
  const auto add = [&](const Vector3& p, double s) {
    cut.points_.push_back(p);
    cut.arc_.push_back(s);
  };
  const auto on_segment = [&](int i, double offset) {
    const double span = arc_[i + 1] - arc_[i];
    return span > 0 ? Vector3(points_[i] + offset / span * (points_[i + 1] - points_[i])) : points_[i];
  };
  const int last = static_cast<int>(points_.size()) - 2;
  const auto share_of = [&](int i) { return std::min(reach, kShare * (arc_[i + 1] - arc_[i])); };
  const Vector3 seam = 0.5 * (on_segment(0, share_of(0)) + on_segment(last, arc_[last + 1] - arc_[last] - share_of(last)));
  add(closed_ ? seam : points_.front(), 0);
  for (int i = 0; i <= last; ++i) {
    const double span = arc_[i + 1] - arc_[i], share = share_of(i);
    if (closed_ || i > 0) add(on_segment(i, share), arc_[i] + share);
    if (closed_ || i < last) add(on_segment(i, span - share), arc_[i + 1] - share);
  }
  add(closed_ ? seam : points_.back(), length());
  return cut;
}

void CurveGeometry::weigh_by_curvature(double h, double weight) {
  constexpr double kWindow = 0.5;
  constexpr double kReach = 0.2;  // farther from a corner the curve stays as it is: a coarse one bends in its corners only
  const CurveGeometry smooth = with_cut_corners(kReach * h).with_cut_corners(kReach * h);
  std::vector<double> curvature(points_.size(), 0.0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double low = closed_ ? arc_[i] - kWindow * h : std::max(0.0, arc_[i] - kWindow * h);
    const double high = closed_ ? arc_[i] + kWindow * h : std::min(length(), arc_[i] + kWindow * h);
    if (high - low > 1e-9 * h) curvature[i] = smooth.turning(low, high) / ((high - low) / 2);
  }
  for (std::size_t i = 0; i + 1 < points_.size(); ++i)
    weighted_[i + 1] = weighted_[i] + (arc_[i + 1] - arc_[i]) * std::sqrt(1 + weight * h * 0.5 * (curvature[i] + curvature[i + 1]));
}

double CurveGeometry::weighted(double s) const {
  const int i = segment_at(s);
  const double span = arc_[i + 1] - arc_[i];
  return span > 0 ? weighted_[i] + (s - arc_[i]) / span * (weighted_[i + 1] - weighted_[i]) : weighted_[i];
}

double CurveGeometry::weight_density(double s) const {
  const int i = segment_at(s);
  const double span = arc_[i + 1] - arc_[i];
  return span > 0 ? (weighted_[i + 1] - weighted_[i]) / span : 1.0;
}

}  // namespace hybrid_quad
