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

void CurveGeometry::weigh_by_curvature(double h, double weight) {
  std::vector<double> curvature(points_.size(), 0.0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double low = closed_ ? arc_[i] - 0.4 * h : std::max(0.0, arc_[i] - 0.4 * h);
    const double high = closed_ ? arc_[i] + 0.4 * h : std::min(length(), arc_[i] + 0.4 * h);
    if (high - low > 1e-9 * h) curvature[i] = turning(low, high) / ((high - low) / 2);
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
