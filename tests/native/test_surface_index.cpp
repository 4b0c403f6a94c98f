#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "hybrid_quad/mesh/needle_axes.h"
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

TEST(SurfaceIndex, WithoutRegionsFindsWhatOneThatNeverKnewAnyFinds) {
  const TriangleMesh m = test::torus(24, 12);
  std::vector<int> regions(m.face_count());
  for (int f = 0; f < m.face_count(); ++f) regions[f] = f % 3;
  const SurfaceIndex with(m, regions), without = with.without_regions(), never(m, {});
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-2, 2);
  int other_ways = 0;  // that regions make a difference to
  for (int i = 0; i < 300; ++i) {
    const Vector3 p(u(random), u(random), u(random));
    SurfaceIndex::Filter filter;
    filter.region = i % 4 - 1;
    if (i % 2) filter.hint = i % m.face_count();
    EXPECT_EQ(without.nearest(p, filter).face, never.nearest(p, filter).face);
    EXPECT_EQ(without.nearest(p, filter).position, never.nearest(p, filter).position);
    EXPECT_EQ(without.walk(p, i % m.face_count()).face, never.walk(p, i % m.face_count()).face);
    other_ways += with.walk(p, i % m.face_count()).face != never.walk(p, i % m.face_count()).face;
  }
  EXPECT_GT(other_ways, 0);
}

TEST(SurfaceIndex, AnyFaceIsFoundWhereTheNearestIs) {
  const TriangleMesh m = test::torus(24, 12);
  const SurfaceIndex index(m, {});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-2, 2);
  int found = 0;
  long long boxes_of_any = 0, boxes_of_nearest = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3 p(u(random), u(random), u(random));
    SurfaceIndex::Filter filter;
    filter.normal = Vector3(u(random), u(random), u(random)).normalized();
    filter.min_cosine = 0.3;
    filter.within = 0.8;
    const SurfacePoint nearest = index.nearest(p, filter);
    filter.any = true;
    const SurfacePoint any = index.nearest(p, filter);
    ASSERT_EQ(any.face >= 0, nearest.face >= 0);
    boxes_of_any += any.boxes_opened;
    boxes_of_nearest += nearest.boxes_opened;
    if (any.face < 0) continue;
    ++found;
    EXPECT_GE(m.normal(any.face).dot(filter.normal), filter.min_cosine);
    EXPECT_LT(any.squared_distance, filter.within * filter.within);
    EXPECT_GE(any.squared_distance, nearest.squared_distance);
  }
  EXPECT_GT(found, 50);
  EXPECT_LT(found, 450);
  EXPECT_LT(boxes_of_any, boxes_of_nearest);
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

/// A torus, and strips of slanting needles: fans from one end to a row of vertices along the other side.
TriangleMesh torus_and_needles() {
  const TriangleMesh torus = test::torus(24, 12);
  std::vector<Vector3> positions = torus.positions();
  std::vector<std::array<int, 3>> faces = torus.faces();
  constexpr int kNeedles = 100;
  for (const Vector3& along : {Vector3(1, 0.5, -0.7), Vector3(-0.2, 1, 0.4), Vector3(2, 0, 0)}) {
    const Vector3 across = 1e-3 * along.cross(Vector3(0, 0, 1));
    const int tip = static_cast<int>(positions.size());
    positions.push_back(along);
    for (int i = 0; i <= kNeedles; ++i) positions.emplace_back(-along * (0.5 + 0.5 * i / kNeedles) + across);
    for (int i = 1; i <= kNeedles; ++i) faces.push_back({tip, tip + i, tip + i + 1});
  }
  return TriangleMesh(std::move(positions), std::move(faces));
}

TEST(SurfaceIndex, FindsWhatBruteForceFindsAmongNeedles) {
  const TriangleMesh m = torus_and_needles();
  ASSERT_FALSE(NeedleAxes(m).empty());
  const SurfaceIndex index(m, {});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 500; ++i) {
    const Vector3 anywhere(u(random), u(random), u(random));
    const auto& face = m.face(static_cast<int>(random() % m.face_count()));
    const Vector3 p = i % 2 ? anywhere : Vector3(m.position(face[0]) * 0.3 + m.position(face[1]) * 0.7 + 1e-3 * anywhere);
    const SurfacePoint q = index.nearest(p);
    ASSERT_GE(q.face, 0);
    EXPECT_NEAR(q.squared_distance, brute_force(m, p, -1, {}), 1e-12);
    const Vector3 reach = Vector3::Constant(i % 3 ? 0.05 : 0.4);
    std::vector<char> is_met(m.face_count(), 0);
    index.any_in_box(p - reach, p + reach, [&](int f) { return is_met[f] = 1, false; });
    int missed = 0;
    for (int f = 0; f < m.face_count(); ++f)
      for (const double t : {0.0, 0.1, 0.25, 0.4, 0.5, 0.6, 0.8, 1.0}) {
        const auto& v = m.face(f);
        const Vector3 on_face = (1 - t) * m.position(v[0]) + 0.5 * t * (m.position(v[1]) + m.position(v[2]));
        missed += ((on_face - p).cwiseAbs().array() < reach.array()).all() && !is_met[f];
      }
    EXPECT_EQ(missed, 0);
  }
}

TEST(NeedleAxes, LieAlongNeedlesOfOneDirection) {
  const auto turn_of = [](const std::vector<Vector3>& directions) {
    std::vector<Vector3> positions;
    std::vector<std::array<int, 3>> faces;
    for (const Vector3& d : directions) {
      const int first = static_cast<int>(positions.size());
      for (const Vector3& p : {Vector3(0, 0, 0), d, Vector3(d + 1e-4 * Vector3(1, -2, 3))}) positions.push_back(p);
      faces.push_back({first, first + 1, first + 2});
    }
    const NeedleAxes needles(TriangleMesh(positions, faces));
    EXPECT_FALSE(needles.empty());
    Eigen::Matrix3d group = Eigen::Matrix3d::Zero();
    for (std::size_t f = 0; f < faces.size(); ++f) needles.add_to(group, static_cast<int>(f));
    return NeedleAxes::turn_of(group);
  };
  const Vector3 slanting(1, 2, -0.5);
  const Eigen::Matrix3d turn = turn_of({slanting, 1.5 * slanting, -slanting});
  EXPECT_NEAR(std::abs((turn * slanting.normalized())[0]), 1, 1e-6);
  EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_TRUE(turn_of({slanting, Vector3(2, -1, 0)}).isIdentity(0)) << "two directions";
  EXPECT_TRUE(NeedleAxes(test::torus(24, 12)).empty());
}

TEST(SurfaceIndex, SameForAnyNumberOfThreads) {
  const TriangleMesh m = test::torus(97, 45);
  RunContext on_three;
  on_three.threads = 3;
  const SurfaceIndex one(m, {}), three(m, {}, on_three);
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

TEST(SurfaceIndex, AsksWhetherToGoOnWhileItIsBuilt) {
  const TriangleMesh m = test::torus(400, 200);
  RunContext context;
  int asked = 0;
  context.stop_requested = [&] { return ++asked, false; };
  context.on_progress = [](const std::string&, double) { ADD_FAILURE() << "parts built at once tell no progress"; };
  const SurfaceIndex index(m, {}, context);
  EXPECT_GT(asked, m.face_count() / 10000) << "every few milliseconds";
  for (const int last : {1, asked / 2, asked}) {
    int left = last;
    context.stop_requested = [&] { return --left <= 0; };
    EXPECT_THROW(SurfaceIndex(m, {}, context), Cancelled);
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
