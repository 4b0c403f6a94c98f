#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/quality/quality.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

constexpr int kSide = 12, kFine = 10;
constexpr double kCentre = 6.5;

/// A square with a smooth horn in the middle of a quad.
TriangleMesh horn(double height, double radius) {
  const TriangleMesh flat = test::flat_grid(kSide * kFine, kSide * kFine, kSide, kSide);
  std::vector<Vector3> positions;
  for (int v = 0; v < flat.vertex_count(); ++v) {
    Vector3 p = flat.position(v);
    const double r = std::min(1.0, std::hypot(p.x() - kCentre, p.y() - kCentre) / radius);
    p.z() = 0.5 * height * (1 + std::cos(M_PI * r));
    positions.push_back(p);
  }
  std::vector<std::array<int, 3>> faces;
  for (int f = 0; f < flat.face_count(); ++f) faces.push_back(flat.face(f));
  return TriangleMesh(std::move(positions), std::move(faces));
}

FeatureGraph boundary_of(const TriangleMesh& mesh) {
  FeatureOptions options;
  options.use_sharp_angle = false;
  return detect_features(mesh, options, RunContext{});
}

/// Even quads whose vertices are around the horn's foot.
struct CutHorn {
  explicit CutHorn(double height)
      : input(horn(height, 0.7)),
        features(boundary_of(input)),
        index(input, features.face_region),
        quads(test::even_quads(kSide, features.face_region[0])) {}
  int reach(int threads = 1) {
    RunContext context;
    context.threads = threads;
    return reach_cut_parts(quads, input, features, index, ImproveOptions{}, context);
  }
  double farthest() const { return surface_distance(quads, index, RunContext{}).input_to_quads_max * input.diagonal() / 100; }

  TriangleMesh input;
  FeatureGraph features;
  SurfaceIndex index;
  QuadMesh quads;
};

TEST(ReachCutParts, QuadsComeNearerToATipAndWhatIsFarStays) {
  CutHorn horn(1.5);
  const QuadMesh before = horn.quads;
  ASSERT_NEAR(horn.farthest(), 1.5, 0.01);
  EXPECT_GT(horn.reach(), 0);
  EXPECT_LT(horn.farthest(), 0.75);
  EXPECT_EQ(horn.quads.quads, before.quads);
  EXPECT_GT(shape_quality(horn.quads).scaled_jacobian_min, 0.39);
  EXPECT_TRUE(flawed_quads(horn.quads, horn.index, {}).empty());
  for (std::size_t v = 0; v < before.positions.size(); ++v)
    if ((before.positions[v] - Vector3(kCentre, kCentre, 0)).head<2>().lpNorm<Eigen::Infinity>() > 5) {
      EXPECT_EQ(horn.quads.positions[v], before.positions[v]);
    }
  for (const Vector3& p : horn.quads.positions) EXPECT_LT(horn.index.nearest(p).squared_distance, 1e-12);
}

TEST(ReachCutParts, WhatQuadsReachStays) {
  CutHorn low(0.3);
  const QuadMesh before = low.quads;
  EXPECT_EQ(low.reach(), 0);
  EXPECT_EQ(low.quads.positions, before.positions);
}

TEST(ReachCutParts, VerticesThatMayNotMoveStay) {
  CutHorn horn(1.5);
  std::fill(horn.quads.kind.begin(), horn.quads.kind.end(), VertexKind::kCorner);
  std::fill(horn.quads.anchor.begin(), horn.quads.anchor.end(), -1);
  const QuadMesh before = horn.quads;
  EXPECT_EQ(horn.reach(), 0);
  EXPECT_EQ(horn.quads.positions, before.positions);
}

TEST(ReachCutParts, TheSameForAnyNumberOfThreads) {
  CutHorn one(1.5), four(1.5);
  EXPECT_EQ(one.reach(1), four.reach(4));
  EXPECT_EQ(one.quads.positions, four.quads.positions);
}

}  // namespace
}  // namespace hybrid_quad
