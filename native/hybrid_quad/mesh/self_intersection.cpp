#include "hybrid_quad/mesh/self_intersection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hybrid_quad {

namespace {

/// Heights and overlaps below this part of the triangles' size are rounding, not room.
constexpr double kTouch = 1e-9;

using Triangle = std::array<Vector3, 3>;

double size_of(const Triangle& t) {
  return std::sqrt(std::max({(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()}));
}

/// Heights of b's corners over a's plane; zero where they are no more than rounding.
std::array<double, 3> heights(const Triangle& a, const Triangle& b, const Vector3& unit_normal, double tolerance) {
  std::array<double, 3> h;
  for (int i = 0; i < 3; ++i) {
    h[i] = unit_normal.dot(b[i] - a[0]);
    if (std::abs(h[i]) <= tolerance) h[i] = 0;
  }
  return h;
}

bool on_one_side(const std::array<double, 3>& h) {
  return std::min({h[0], h[1], h[2]}) >= 0 || std::max({h[0], h[1], h[2]}) <= 0;
}

/// The part of the line of both planes that lies in a triangle, as an interval along `direction`.
std::array<double, 2> interval(const Triangle& t, const std::array<double, 3>& h, const Vector3& direction) {
  std::array<double, 2> range{HUGE_VAL, -HUGE_VAL};
  const auto add = [&](const Vector3& p) {
    const double x = direction.dot(p);
    range = {std::min(range[0], x), std::max(range[1], x)};
  };
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (h[i] == 0) add(t[i]);
    if (h[i] * h[j] < 0) add(t[i] + (t[j] - t[i]) * (h[i] / (h[i] - h[j])));
  }
  return range;
}

/// Whether the side of triangle t from corner i parts it from another of the same plane.
bool side_parts(const Triangle& t, int i, const Triangle& other, const Vector3& normal, double tolerance) {
  Vector3 inward = normal.cross(t[(i + 1) % 3] - t[i]).normalized();
  if (inward.dot(t[(i + 2) % 3] - t[i]) < 0) inward = -inward;
  return std::all_of(other.begin(), other.end(), [&](const Vector3& p) { return inward.dot(p - t[i]) <= tolerance; });
}

bool overlap_in_plane(const Triangle& a, const Triangle& b, const Vector3& normal, double tolerance) {
  for (int i = 0; i < 3; ++i)
    if (side_parts(a, i, b, normal, tolerance) || side_parts(b, i, a, normal, tolerance)) return false;
  return true;
}

/// Moeller, A Fast Triangle-Triangle Intersection Test (1997), with room for rounding.
bool cross_each_other(const Triangle& a, const Triangle& b) {
  const double tolerance = kTouch * std::max(size_of(a), size_of(b));
  const Vector3 na = (a[1] - a[0]).cross(a[2] - a[0]).normalized(), nb = (b[1] - b[0]).cross(b[2] - b[0]).normalized();
  const std::array<double, 3> hb = heights(a, b, na, tolerance), ha = heights(b, a, nb, tolerance);
  const auto is_flat = [](const std::array<double, 3>& h) { return h[0] == 0 && h[1] == 0 && h[2] == 0; };
  if (is_flat(ha) || is_flat(hb)) return is_flat(ha) && is_flat(hb) && overlap_in_plane(a, b, na, tolerance);
  if (on_one_side(ha) || on_one_side(hb)) return false;
  const Vector3 direction = na.cross(nb).normalized();
  const auto ra = interval(a, ha, direction), rb = interval(b, hb, direction);
  return std::min(ra[1], rb[1]) - std::max(ra[0], rb[0]) > tolerance;
}

}  // namespace

SelfIntersections self_intersecting_faces(const SurfaceIndex& index) {
  const TriangleMesh& mesh = index.mesh();
  std::vector<char> found(mesh.face_count(), 0);
  // Where thousands of faces lie about one place, as around the tip of a fan, every pair of them would be looked at.
  constexpr double kLeastPairs = 1e7, kPairsAFace = 100;
  double pairs_left = kLeastPairs + kPairsAFace * mesh.face_count();
  const auto triangle = [&mesh](int f) {
    const auto& t = mesh.face(f);
    return Triangle{mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])};
  };
  for (int f = 0; f < mesh.face_count() && pairs_left >= 0; ++f) {
    if (found[f]) continue;
    const Triangle t = triangle(f);
    const Vector3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    index.any_in_box(low, high, [&](int g) {
      if (--pairs_left < 0) return true;
      if (g == f || !cross_each_other(t, triangle(g))) return false;
      found[f] = found[g] = 1;
      return true;
    });
  }
  SelfIntersections out{{}, pairs_left >= 0};
  for (int f = 0; f < mesh.face_count(); ++f)
    if (found[f]) out.faces.push_back(f);
  return out;
}

}  // namespace hybrid_quad
