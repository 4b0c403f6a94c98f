#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "hybrid_quad/mesh/surface_index.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

double brute_force(const TriangleMesh& m, const Vector3& p, int region, const std::vector<int>& regions) {
  double best = 1e300;
  for (int f = 0; f < m.face_count(); ++f) {
    if (region >= 0 && regions[f] != region) continue;
    const auto& t = m.face(f);
    best = std::min(best, (nearest_on_triangle(p, m.position(t[0]), m.position(t[1]), m.position(t[2])) - p).squaredNorm());
  }
  return best;
}

TEST(SurfaceIndex, FindsWhatBruteForceFinds) {
  const TriangleMesh m = test::torus(24, 12);
  std::vector<int> regions(m.face_count());
  for (int f = 0; f < m.face_count(); ++f) regions[f] = f % 3;
  const SurfaceIndex index(m, regions);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-2, 2);
  for (int i = 0; i < 300; ++i) {
    const Vector3 p(u(random), u(random), u(random));
    SurfaceIndex::Filter filter;
    filter.region = i % 4 - 1;
    if (i % 2) filter.hint = i % m.face_count();
    const SurfacePoint q = index.nearest(p, filter);
    ASSERT_GE(q.face, 0);
    EXPECT_NEAR(q.squared_distance, brute_force(m, p, filter.region, regions), 1e-12);
    EXPECT_NEAR((q.position - p).squaredNorm(), q.squared_distance, 1e-12);
    if (filter.region >= 0) {
      EXPECT_EQ(regions[q.face], filter.region);
    }
  }
}

TEST(SurfaceIndex, SizeAndPlaceMakeNoDifference) {
  const TriangleMesh torus = test::torus(24, 12);
  for (const double size : {1e-30, 1e-3, 1e30})
    for (const double away : {0.0, 1e4}) {
      std::vector<Vector3> positions = torus.positions();
      for (Vector3& p : positions) p = size * (p + Vector3(away, 0, -away));
      const TriangleMesh mesh(std::move(positions), torus.faces());
      const SurfaceIndex index(mesh, {});
      std::mt19937 random(3);
      std::uniform_real_distribution<double> u(-2, 2);
      for (int i = 0; i < 100; ++i) {
        const Vector3 p = size * (Vector3(u(random), u(random), u(random)) + Vector3(away, 0, -away));
        const SurfacePoint q = index.nearest(p);
        ASSERT_GE(q.face, 0);
        EXPECT_NEAR(q.squared_distance / (size * size), brute_force(mesh, p, -1, {}) / (size * size), 1e-9);
      }
      EXPECT_GE(index.nearest(1e25 * size * Vector3(1, 1, 1)).face, 0) << "from however far away";
    }
}

TEST(SurfaceIndex, SameForAnyNumberOfThreads) {
  const TriangleMesh m = test::torus(40, 20);
  const SurfaceIndex one(m, {}), three(m, {}, 3);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-2, 2);
  for (int i = 0; i < 200; ++i) {
    const Vector3 p(u(random), u(random), u(random)), reach = Vector3::Constant(0.3);
    EXPECT_EQ(one.nearest(p).face, three.nearest(p).face);
    std::vector<int> here, there;
    one.any_in_box(p - reach, p + reach, [&](int f) { return here.push_back(f), false; });
    three.any_in_box(p - reach, p + reach, [&](int f) { return there.push_back(f), false; });
    EXPECT_EQ(here, there);
  }
}

TEST(SurfaceIndex, NormalFilterKeepsToOneSideOfAThinSheet) {
  const TriangleMesh m = test::box(4, Vector3(1, 1, 0.01));
  const SurfaceIndex index(m, {});
  SurfaceIndex::Filter filter;
  filter.normal = Vector3(0, 0, 1);
  filter.min_cosine = 0.5;
  const SurfacePoint q = index.nearest(Vector3(0.4, 0.4, 0.001), filter);
  EXPECT_NEAR(q.position.z(), 0.01, 1e-12);
  filter.normal = Vector3(1, 1, 1).normalized();
  filter.min_cosine = 0.9;
  EXPECT_EQ(index.nearest(Vector3(0, 0, 0), filter).face, -1);
}

TEST(SurfaceIndex, WalkReachesTheNearestPointOfAConvexSurface) {
  const TriangleMesh m = test::icosphere(3);
  const SurfaceIndex index(m, {});
  for (int f = 0; f < m.face_count(); f += 37) {
    const Vector3 p = 1.1 * Vector3(0.3, -0.5, 0.8);
    EXPECT_NEAR(index.walk(p, f).squared_distance, index.nearest(p).squared_distance, 1e-12);
  }
}

/// A strip of needles across its way: each is one step.
TEST(SurfaceIndex, WalkEndsHoweverManyTrianglesLieOnItsWay) {
  constexpr int kCount = 5000;
  std::vector<Vector3> positions;
  std::vector<std::array<int, 3>> faces;
  for (int i = 0; i <= kCount; ++i) {
    positions.emplace_back(i, 0, 0);
    positions.emplace_back(i, 1e4, 0);
    if (i == kCount) break;
    faces.push_back({2 * i, 2 * i + 2, 2 * i + 1});
    faces.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
  }
  const TriangleMesh m(std::move(positions), std::move(faces));
  const SurfaceIndex index(m, {});
  const Vector3 near(400.2, 5000, 1), far(4900.2, 5000, 1);
  EXPECT_NEAR(index.walk(near, 0).squared_distance, 1, 1e-9);
  const SurfacePoint ended = index.walk(far, 0);
  EXPECT_GT(ended.squared_distance, 2) << "it went all the way";
  EXPECT_LT(std::sqrt(ended.squared_distance), 4900.2 - 400) << "it went in that direction";
  EXPECT_NEAR((ended.position - far).squaredNorm(), ended.squared_distance, 1e-6);
  SurfaceIndex::Filter filter;
  filter.hint = 0;
  EXPECT_NEAR(index.nearest(far, filter).squared_distance, 1, 1e-9) << "a hint is no more than that";
}

TEST(SurfaceIndex, DegenerateTriangleActsAsItsSegment) {
  const Vector3 q = nearest_on_triangle({0.5, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0.3, 0, 0});
  EXPECT_NEAR((q - Vector3(0.5, 0, 0)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace hybrid_quad
