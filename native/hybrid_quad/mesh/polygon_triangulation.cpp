#include "hybrid_quad/mesh/polygon_triangulation.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace hybrid_quad {

namespace {

double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The polygon's corners in its best plane, counterclockwise.
std::vector<Vector2> flattened(const std::vector<Vector3>& positions, const std::vector<int>& corners) {
  const int n = static_cast<int>(corners.size());
  const Vector3 origin = positions[corners[0]];
  Vector3 normal = Vector3::Zero();
  for (int i = 0; i < n; ++i)
    normal += (positions[corners[i]] - origin).cross(positions[corners[(i + 1) % n]] - origin);
  if (!(normal.norm() > 0)) normal = Vector3(0, 0, 1);
  const Vector3 u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
  std::vector<Vector2> flat(n);
  for (int i = 0; i < n; ++i) flat[i] = {u.dot(positions[corners[i]] - origin), v.dot(positions[corners[i]] - origin)};
  return flat;
}

bool is_inside(const Vector2& p, const Vector2& a, const Vector2& b, const Vector2& c) {
  return cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0;
}

/// Twice the area over the sum of squared sides: how good an ear is; <= 0 if it is none.
double ear_quality(const std::vector<Vector2>& p, const std::vector<int>& left, int i) {
  const int n = static_cast<int>(left.size());
  const Vector2 &a = p[left[(i + n - 1) % n]], &b = p[left[i]], &c = p[left[(i + 1) % n]];
  const double area2 = cross(b - a, c - a);
  if (!(area2 > 0)) return 0;
  for (int j = 0; j < n; ++j) {
    const Vector2& q = p[left[j]];
    if (q != a && q != b && q != c && is_inside(q, a, b, c)) return 0;
  }
  return area2 / ((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm());
}

/// Whether a triangle has an area in space, and none, or a negative one, in the plane.
bool stands_across(const std::array<Vector3, 3>& p, const std::array<Vector2, 3>& flat) {
  constexpr double kRounding = 1e-12;
  const Vector3 a = p[1] - p[0], b = p[2] - p[0];
  const double area2 = a.cross(b).norm();
  return area2 > kRounding * (a.squaredNorm() + b.squaredNorm()) && !(cross(flat[1] - flat[0], flat[2] - flat[0]) > kRounding * area2);
}

/// Corners of ears, cut off one after the other.
/// \param proper  becomes whether they all lie side by side in the plane
std::vector<std::array<int, 3>> cut_ears(const std::vector<Vector2>& flat, bool& proper) {
  std::vector<int> left(flat.size());
  std::iota(left.begin(), left.end(), 0);
  proper = true;
  constexpr double kBetter = 1 + 1e-9;  // what is better by less is as good, but for rounding
  constexpr int kLargePolygon = 64;  // beyond it the first ear is taken: the best one costs O(n^3) in all
  std::vector<std::array<int, 3>> triangles;
  while (left.size() > 3) {
    const int n = static_cast<int>(left.size());
    int best = -1;
    double best_quality = 0;
    for (int i = 0; i < n && (best < 0 || n <= kLargePolygon); ++i) {
      const double quality = ear_quality(flat, left, i);
      if (quality > kBetter * best_quality) {
        best_quality = quality;
        best = i;
      }
    }
    if (best < 0) {  // the polygon crosses itself or has no area
      best = 0;
      proper = false;
    }
    triangles.push_back({left[(best + n - 1) % n], left[best], left[(best + 1) % n]});
    left.erase(left.begin() + best);
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

std::vector<std::array<int, 3>> fan(int corners, int first) {
  std::vector<std::array<int, 3>> triangles;
  for (int i = 1; i + 1 < corners; ++i) triangles.push_back({first, (first + i) % corners, (first + i + 1) % corners});
  return triangles;
}

Vector3 twice_area(const std::vector<Vector3>& positions, const std::vector<int>& corners, const std::array<int, 3>& t) {
  const Vector3& a = positions[corners[t[0]]];
  return (positions[corners[t[1]]] - a).cross(positions[corners[t[2]]] - a);
}

/// Whether triangles are bent along the sides between them by what can be seen.
bool is_bent(const std::vector<Vector3>& positions, const std::vector<int>& corners, const std::vector<std::array<int, 3>>& triangles) {
  constexpr double kSine = 0.01;
  for (std::size_t i = 0; i + 1 < triangles.size(); ++i) {
    const Vector3 a = twice_area(positions, corners, triangles[i]), b = twice_area(positions, corners, triangles[i + 1]);
    if (a.cross(b).norm() > kSine * a.norm() * b.norm()) return true;
  }
  return false;
}

}  // namespace

std::vector<std::array<int, 3>> triangulate_polygon(const std::vector<Vector3>& positions, const std::vector<int>& corners, int first) {
  if (corners.size() == 3) return {{corners[0], corners[1], corners[2]}};
  const std::vector<Vector2> flat = flattened(positions, corners);
  bool proper = true;
  std::vector<std::array<int, 3>> triangles = cut_ears(flat, proper);
  const auto is_across = [&](const std::array<int, 3>& t) {
    return stands_across({positions[corners[t[0]]], positions[corners[t[1]]], positions[corners[t[2]]]}, {flat[t[0]], flat[t[1]], flat[t[2]]});
  };
  const std::vector<std::array<int, 3>> as_fan = fan(static_cast<int>(corners.size()), first);
  const bool is_side_by_side = std::none_of(as_fan.begin(), as_fan.end(), is_across);
  // Ears have an area in the plane, but for the last one, and for those of a polygon that has none.
  if ((is_side_by_side && is_bent(positions, corners, as_fan)) || is_across(triangles.back()) ||
      (!proper && std::any_of(triangles.begin(), triangles.end(), is_across)))
    triangles = as_fan;
  for (std::array<int, 3>& t : triangles)
    for (int& i : t) i = corners[i];
  return triangles;
}

void begin_far_from(const Vector3& point, const std::vector<Vector3>& positions, std::vector<int>& corners) {
  constexpr double kFarther = 1 + 1e-9;
  std::size_t start = 0;
  for (std::size_t i = 1; i < corners.size(); ++i)
    if ((positions[corners[i]] - point).squaredNorm() > kFarther * (positions[corners[start]] - point).squaredNorm()) start = i;
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(start), corners.end());
}

}  // namespace hybrid_quad
