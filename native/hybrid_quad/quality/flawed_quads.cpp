#include <algorithm>
#include <cmath>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

Vector3 area_vector(const std::array<Vector3, 4>& p) { return 0.5 * (p[2] - p[0]).cross(p[3] - p[1]); }

std::array<Vector3, 4> corners_of(const QuadMesh& mesh, int q) {
  const auto& v = mesh.quads[q];
  return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]], mesh.positions[v[3]]};
}

std::array<Vector3, 3> corners_of(const TriangleMesh& mesh, int f) {
  const auto& t = mesh.face(f);
  return {mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])};
}

struct Ball {
  Vector3 centre;
  double radius;
  bool holds(const Vector3& p) const { return (p - centre).squaredNorm() < radius * radius; }
};

/// Area, signed by its turn, of the triangle (0, p, q) inside the circle of that radius about 0.
double area_in_circle(const Eigen::Vector2d& p, const Eigen::Vector2d& q, double radius) {
  const auto cross = [](const Eigen::Vector2d& x, const Eigen::Vector2d& y) { return x[0] * y[1] - x[1] * y[0]; };
  const auto sector = [&](const Eigen::Vector2d& x, const Eigen::Vector2d& y) {
    return 0.5 * radius * radius * std::atan2(cross(x, y), x.dot(y));
  };
  // |p + t d| = radius
  const Eigen::Vector2d d = q - p;
  const double a = d.squaredNorm(), b = p.dot(d), root2 = b * b - a * (p.squaredNorm() - radius * radius);
  if (!(a > 0) || root2 <= 0) return sector(p, q);
  const double enters = (-b - std::sqrt(root2)) / a, leaves = (-b + std::sqrt(root2)) / a;
  if (enters >= 1 || leaves <= 0) return sector(p, q);
  const Eigen::Vector2d in = p + std::max(enters, 0.0) * d, out = p + std::min(leaves, 1.0) * d;
  return sector(p, in) + 0.5 * cross(in, out) + sector(out, q);
}

/// Area of a triangle inside a ball. \param normal  of the triangle, of length 1
double area_in_ball(const std::array<Vector3, 3>& triangle, const Vector3& normal, const Ball& ball) {
  if (!ball.holds(nearest_on_triangle(ball.centre, triangle[0], triangle[1], triangle[2]))) return 0;
  const double height = normal.dot(triangle[0] - ball.centre);
  const double radius2 = ball.radius * ball.radius - height * height;
  if (!(radius2 > 0)) return 0;
  const Vector3 x = normal.unitOrthogonal(), y = normal.cross(x);
  std::array<Eigen::Vector2d, 3> p;
  for (int i = 0; i < 3; ++i) p[i] = {x.dot(triangle[i] - ball.centre), y.dot(triangle[i] - ball.centre)};
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += area_in_circle(p[i], p[(i + 1) % 3], std::sqrt(radius2));
  return std::abs(sum);
}

/// Whether a face passes the filter. \param lookup  to count in
bool has_any(const SurfaceIndex& surface, const Vector3& p, SurfaceIndex::Filter filter, Lookup& lookup) {
  filter.any = true;
  const SurfacePoint point = surface.nearest(p, filter);
  lookup.boxes_opened += point.boxes_opened;
  return point.face >= 0;
}

/// Whether a face that is as near to p as the nearest one points against a normal.
bool points_against(const SurfaceIndex& surface, const Vector3& p, const SurfacePoint& nearest, const Vector3& normal,
                    double touches, Lookup& lookup) {
  constexpr double kAgainst = 0.15;
  SurfaceIndex::Filter against;
  against.normal = -normal;
  against.min_cosine = kAgainst;
  against.within = std::sqrt(nearest.squared_distance) + touches;
  return has_any(surface, p, against, lookup);
}

constexpr double kAgrees = 0.05;

/// Faces in a ball that agree with a normal.
SurfaceIndex::Filter those_that_agree(const Ball& ball, const Vector3& normal) {
  SurfaceIndex::Filter along;
  along.normal = normal;
  along.min_cosine = kAgrees;
  along.within = ball.radius;
  return along;
}

/// Whether a face that agrees with a normal reaches with its inside to within `distance` of the ball's centre, and faces that
/// agree have about as much area in the ball as those that do not: two sheets in one place, not the edge of one.
bool coincides(const SurfaceIndex& surface, const Ball& ball, double distance, const Vector3& normal, Lookup& lookup) {
  constexpr double kInside = 1e-3;  // of the face's area
  constexpr double kAsMuch = 0.5;
  const SurfacePoint point = surface.nearest(ball.centre, those_that_agree({ball.centre, distance}, normal));
  lookup.boxes_opened += point.boxes_opened;
  if (point.face < 0) return false;
  const TriangleMesh& mesh = surface.mesh();
  const std::array<Vector3, 3> p = corners_of(mesh, point.face);
  const double area = (p[1] - p[0]).cross(p[2] - p[0]).norm();
  for (int i = 0; i < 3; ++i)
    if ((p[i] - point.position).cross(p[(i + 1) % 3] - point.position).norm() < kInside * area) return false;
  const Vector3 reach = Vector3::Constant(ball.radius);
  double along = 0, against = 0;
  surface.any_in_box(ball.centre - reach, ball.centre + reach, [&](int f) {
    (surface.normal(f).dot(normal) < kAgrees ? against : along) += area_in_ball(corners_of(mesh, f), surface.normal(f), ball);
    return false;
  });
  return along >= kAsMuch * against;
}

/// Whether a face agrees with a normal and has that much area in a ball, or its middle.
bool agrees_enough(const SurfaceIndex& surface, int f, const Ball& ball, const Vector3& normal, double enough_area) {
  if (surface.normal(f).dot(normal) < kAgrees) return false;
  const std::array<Vector3, 3> p = corners_of(surface.mesh(), f);
  return ball.holds((p[0] + p[1] + p[2]) / 3) || area_in_ball(p, surface.normal(f), ball) > std::max(enough_area, 0.0);
}

/// Whether the faces in a ball that agree with a normal have that much area there, or one of them has its middle there.
bool agrees_in(const SurfaceIndex& surface, const Ball& ball, const Vector3& normal, double enough_area, Lookup& lookup) {
  if (!has_any(surface, ball.centre, those_that_agree(ball, normal), lookup)) return false;
  if (enough_area <= 0) return true;
  const TriangleMesh& mesh = surface.mesh();
  const Vector3 reach = Vector3::Constant(ball.radius);
  double area = 0;
  return surface.any_in_box(ball.centre - reach, ball.centre + reach, [&](int f) {
    if (surface.normal(f).dot(normal) < kAgrees) return false;
    const std::array<Vector3, 3> p = corners_of(mesh, f);
    if (ball.holds((p[0] + p[1] + p[2]) / 3)) return true;
    area += area_in_ball(p, surface.normal(f), ball);
    return area >= enough_area;
  });
}

/// Of a quad that counts as one.
double least_area_of(const QuadMesh& mesh) {
  constexpr double kLeastArea = 1e-10;
  double sum = 0;
  for (const auto& v : mesh.quads)
    for (int i = 0; i < 4; ++i) sum += (mesh.positions[v[(i + 1) % 4]] - mesh.positions[v[i]]).norm();
  const double mean = sum / (4.0 * static_cast<double>(mesh.quads.size()));
  return kLeastArea * mean * mean;
}

/// The quads for which test(q, lookup) holds, ascending. Quads in turn are mostly neighbours: where one was looked up tells where the next one is.
template <class Test>
std::vector<int> quads_that(const QuadMesh& mesh, int threads, const Test& test) {
  constexpr int kChunk = 256;
  const int count = static_cast<int>(mesh.quads.size());
  std::vector<char> holds(count, 0);
  parallel_for((count + kChunk - 1) / kChunk, threads, [&](int c) {
    Lookup lookup;
    for (int q = c * kChunk; q < std::min(count, (c + 1) * kChunk); ++q) holds[q] = test(q, lookup);
  });
  std::vector<int> found;
  for (int q = 0; q < count; ++q)
    if (holds[q]) found.push_back(q);
  return found;
}

}  // namespace

bool is_inverted(const std::array<Vector3, 4>& corners, const SurfaceIndex& surface, const Agreement& agreement, Lookup* lookup) {
  constexpr double kReach = 0.28, kTouches = 1e-6;
  Vector3 normal = area_vector(corners);
  const double area = normal.norm();
  if (!(area > 0)) return false;
  normal /= area;
  Vector3 centre = Vector3::Zero();
  double size = 0;
  for (int i = 0; i < 4; ++i) {
    centre += 0.25 * corners[i];
    size += 0.25 * (corners[(i + 1) % 4] - corners[i]).norm();
  }
  Lookup unknown;
  Lookup& known = lookup ? *lookup : unknown;
  // Mostly the face below agrees, and is enough of what is looked for below. A face that points against the quad and is as near as the nearest
  // one is no farther than any: mostly there is none, and one search for both is enough.
  if (known.face >= 0) {
    const SurfacePoint walked = surface.walk(centre, known.face);
    known.face = walked.face;
    if (agrees_enough(surface, walked.face, {centre, kReach * size}, normal, agreement.area)) return false;
    if (walked.squared_distance < size * size && !points_against(surface, centre, walked, normal, kTouches * size, known)) return false;
  }
  SurfaceIndex::Filter filter;
  filter.hint = known.face;
  const SurfacePoint near = surface.nearest(centre, filter);
  known.face = near.face;
  known.boxes_opened += near.boxes_opened;
  if (near.face < 0 || !points_against(surface, centre, near, normal, kTouches * size, known)) return false;
  const double distance = std::sqrt(near.squared_distance);
  const Ball ball{centre, distance + kReach * size};
  // A needle may fill a sheet that is as narrow: what lies beside it does not count.
  const Ball within{centre, distance + kReach * std::min(size, area / size)};
  return !agrees_in(surface, ball, normal, agreement.area, known) &&
         !(agreement.or_coincides && coincides(surface, within, distance + kTouches * size, normal, known));
}

std::vector<int> inverted_quads(const QuadMesh& mesh, const SurfaceIndex& surface, const Agreement& agreement, int threads) {
  return quads_that(mesh, threads,
                    [&](int q, Lookup& lookup) { return is_inverted(corners_of(mesh, q), surface, agreement, &lookup); });
}

bool is_flawed(const std::array<Vector3, 4>& corners, double least_area, const SurfaceIndex& surface, const Agreement& agreement,
               Lookup* lookup) {
  return !(area_vector(corners).norm() > least_area) || is_inverted(corners, surface, agreement, lookup);
}

std::vector<int> flawed_quads(const QuadMesh& mesh, const SurfaceIndex& surface, const Agreement& agreement, int threads) {
  const double least_area = least_area_of(mesh);
  return quads_that(mesh, threads, [&](int q, Lookup& lookup) {
    return is_flawed(corners_of(mesh, q), least_area, surface, agreement, &lookup);
  });
}

std::vector<int> flawed_among(const std::vector<int>& candidates, const QuadMesh& mesh, const SurfaceIndex& surface,
                              const Agreement& agreement) {
  const double least_area = least_area_of(mesh);
  std::vector<int> found;
  for (const int q : candidates)
    if (is_flawed(corners_of(mesh, q), least_area, surface, agreement)) found.push_back(q);
  return found;
}

}  // namespace hybrid_quad
