#pragma once

#include <cmath>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// A polyline by arc length. Positions s on a closed one are taken modulo its length, on an open one clamped to it.
class CurveGeometry {
 public:
  /// \param points  at least two; a closed curve repeats its first point at the end
  CurveGeometry(std::vector<Vector3> points, bool closed);

  double length() const { return arc_.back(); }
  bool closed() const { return closed_; }
  const std::vector<Vector3>& points() const { return points_; }
  /// Arc length at the point `fraction` along segment i.
  double arc_length(int segment, double fraction) const {
    return arc_[segment] + fraction * (arc_[segment + 1] - arc_[segment]);
  }

  double normalized(double s) const;
  Vector3 at(double s) const;
  /// Calls visit(point) for the points of the polyline between two arc lengths.
  template <class Visit>
  void for_points_between(double from, double to, const Visit& visit) const;
  Vector3 tangent(double s) const;  ///< unit, in the curve's direction; zero on a curve without length

  /// Weighs arc length by sqrt(1 + weight h curvature), so that equal weighted lengths have about equal chord error.
  /// Curvature is measured over a window of h, with corners cut, or it would depend on how many of them a window holds.
  void weigh_by_curvature(double h, double weight);
  double weighted_length() const { return weighted_.back(); }
  double weighted(double s) const;        ///< weighted length from the start to s
  double weight_density(double s) const;  ///< its derivative

 private:
  int segment_at(double s) const;
  double turning(double from, double to) const;
  /// The curve with its corners cut off as in Chaikin's subdivision, no farther from them than `reach`; positions on it are by
  /// arc length of this one.
  CurveGeometry with_cut_corners(double reach) const;

  std::vector<Vector3> points_;
  std::vector<double> arc_, weighted_;
  bool closed_;
};

template <class Visit>
void CurveGeometry::for_points_between(double from, double to, const Visit& visit) const {
  const int segments = static_cast<int>(points_.size()) - 1;
  const double turns = closed_ && length() > 0 ? std::floor(from / length()) : 0;
  double offset = turns * length();
  for (int i = segment_at(from - offset) + 1;; ++i) {
    if (i > segments) {
      if (!closed_ || !(length() > 0)) return;
      i -= segments;
      offset += length();
    }
    const double s = offset + arc_[i];
    if (s >= to) return;
    if (s > from) visit(points_[i]);
  }
}

}  // namespace hybrid_quad
