#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/quality/quality.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

constexpr int kSide = 12, kFine = 4;
constexpr double kSharp = 40;

/// A roof over a square. Its ridge is `offset` beside the middle, where the sides of even quads are; it may bend along that.
struct Roof {
  double slope, offset, bend = 0;
  double ridge() const { return kSide / 2.0 + offset; }
  Vector3 lifted(double x, double y) const { return {x, y, -slope * std::abs(x - ridge()) - bend * std::pow(y - kSide / 2.0, 2)}; }
};

/// The column of vertices nearest to the ridge is on it.
TriangleMesh roof_mesh(const Roof& roof) {
  const TriangleMesh flat = test::flat_grid(kSide * kFine, kSide * kFine, kSide, kSide);
  const double step = 1.0 / kFine;
  std::vector<Vector3> positions;
  for (int v = 0; v < flat.vertex_count(); ++v) {
    const Vector3 p = flat.position(v);
    const bool is_beside = std::abs(p.x() - std::round(roof.ridge() / step) * step) < step / 2;
    positions.push_back(roof.lifted(is_beside ? roof.ridge() : p.x(), p.y()));
  }
  std::vector<std::array<int, 3>> faces;
  for (int f = 0; f < flat.face_count(); ++f) faces.push_back(flat.face(f));
  return TriangleMesh(std::move(positions), std::move(faces));
}

FeatureGraph features_of(const TriangleMesh& mesh, bool by_angle) {
  FeatureOptions options;
  options.use_sharp_angle = by_angle;
  options.sharp_angle = kSharp;
  return detect_features(mesh, options, RunContext{});
}

/// Even quads on a roof whose ridge is no feature.
struct RoofWithQuads {
  explicit RoofWithQuads(const Roof& r, bool by_angle = false)
      : roof(r),
        input(roof_mesh(r)),
        features(features_of(input, by_angle)),
        index(input, features.face_region),
        quads(test::even_quads(kSide, features.face_region[0])) {
    for (Vector3& p : quads.positions) p = roof.lifted(p.x(), p.y());
  }

  int follow(int threads = 1, bool fit = false, double target_length = 1) {
    RunContext context;
    context.threads = threads;
    ImproveOptions options;
    options.target_length = target_length;
    options.fit = fit;
    return follow_creases(quads, input, features, index, kSharp, options, context);
  }

  /// Largest distance of the ridge from sides.
  double farthest() const {
    double largest = 0;
    for (double y = 2; y <= kSide - 2; y += 0.05) {
      const Vector3 p = roof.lifted(roof.ridge(), y);
      double least = std::numeric_limits<double>::infinity();
      for (const auto& q : quads.quads)
        for (int i = 0; i < 4; ++i) {
          const Vector3& a = quads.positions[q[i]];
          const Vector3 side = quads.positions[q[(i + 1) % 4]] - a;
          const double share = std::clamp((p - a).dot(side) / side.squaredNorm(), 0.0, 1.0);
          least = std::min(least, (a + share * side - p).norm());
        }
      largest = std::max(largest, least);
    }
    return largest;
  }

  Roof roof;
  TriangleMesh input;
  FeatureGraph features;
  SurfaceIndex index;
  QuadMesh quads;
};

TEST(FollowCreases, SidesComeToLieAlongACreaseAndWhatIsFarStays) {
  RoofWithQuads on({0.7, 0.4});
  const QuadMesh before = on.quads;
  ASSERT_GT(on.farthest(), 0.35);
  EXPECT_GT(on.follow(), 0);
  EXPECT_LT(on.farthest(), 0.2);
  EXPECT_EQ(on.quads.quads, before.quads);
  EXPECT_GT(shape_quality(on.quads).scaled_jacobian_min, 0.8);
  EXPECT_TRUE(flawed_quads(on.quads, on.index, {}).empty());
  for (std::size_t v = 0; v < before.positions.size(); ++v) {
    EXPECT_LT(on.index.nearest(on.quads.positions[v]).squared_distance, 1e-12);
    if (std::abs(before.positions[v].x() - on.roof.ridge()) > 5) {
      EXPECT_EQ(on.quads.positions[v], before.positions[v]);
    }
  }
}

TEST(FollowCreases, QuadsAreFittedWhereVerticesMoved) {
  RoofWithQuads fitted({0.7, 0.4, 0.06}), left({0.7, 0.4, 0.06});
  const double before = surface_distance(left.quads, left.index, RunContext{}).mean;
  EXPECT_EQ(fitted.follow(1, true), left.follow(1, false));
  const double without = surface_distance(left.quads, left.index, RunContext{}).mean;
  EXPECT_LT(without, before);
  EXPECT_LT(surface_distance(fitted.quads, fitted.index, RunContext{}).mean, 0.9 * without);
}

TEST(FollowCreases, NothingMovesWhereSidesAreNear) {
  RoofWithQuads on({0.7, 0.1});
  const QuadMesh before = on.quads;
  EXPECT_EQ(on.follow(), 0);
  EXPECT_EQ(on.quads.positions, before.positions);
}

TEST(FollowCreases, BlunterThanTheSharpAngleIsNoCrease) {
  RoofWithQuads on({0.3, 0.4});
  EXPECT_EQ(on.follow(), 0);
}

TEST(FollowCreases, FeaturesAreNoneOfIt) {
  RoofWithQuads on({0.7, 0.4}, true);
  ASSERT_GT(on.features.curves.size(), 1u);
  EXPECT_EQ(on.follow(), 0);
}

TEST(FollowCreases, VerticesThatMayNotMoveStay) {
  RoofWithQuads on({0.7, 0.4});
  std::fill(on.quads.kind.begin(), on.quads.kind.end(), VertexKind::kCorner);
  std::fill(on.quads.anchor.begin(), on.quads.anchor.end(), -1);
  const QuadMesh before = on.quads;
  EXPECT_EQ(on.follow(), 0);
  EXPECT_EQ(on.quads.positions, before.positions);
}

TEST(FollowCreases, NeverFartherAndNeverMuchWorse) {
  for (const double offset : {-0.45, -0.3, -0.2, 0.2, 0.25, 0.35, 0.45, 0.5})
    for (const double slope : {0.5, 1.0, 2.0}) {
      RoofWithQuads on({slope, offset});
      const double distance = on.farthest(), worst = shape_quality(on.quads).scaled_jacobian_min;
      on.follow();
      EXPECT_LE(on.farthest(), distance + 1e-9) << offset << " " << slope;
      EXPECT_GE(shape_quality(on.quads).scaled_jacobian_min, std::min(worst, 0.8) - 0.081) << offset << " " << slope;
      EXPECT_TRUE(flawed_quads(on.quads, on.index, {}).empty());
    }
}

TEST(FollowCreases, EndsWhereCreasesAreMuchLongerThanEdges) {
  RoofWithQuads on({0.7, 0.4});
  const QuadMesh before = on.quads;
  on.follow(1, false, 1e-12);
  EXPECT_EQ(on.quads.quads, before.quads);
  EXPECT_TRUE(flawed_quads(on.quads, on.index, {}).empty());
}

TEST(FollowCreases, TheSameForAnyNumberOfThreads) {
  RoofWithQuads one({0.7, 0.4}), four({0.7, 0.4});
  EXPECT_EQ(one.follow(1), four.follow(4));
  EXPECT_EQ(one.quads.positions, four.quads.positions);
}

}  // namespace
}  // namespace hybrid_quad
