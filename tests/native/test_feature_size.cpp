#include <gtest/gtest.h>

#include <algorithm>

#include "hybrid_quad/sizing/feature_size.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

std::vector<double> lengths(const TriangleMesh& mesh, double length) {
  const RunContext context;
  const FeatureGraph features = detect_features(mesh, FeatureOptions{}, context);
  const SurfaceIndex index(mesh, {});
  return feature_sized_lengths(index, features, length, thin_places(index, length, context), FeatureSizeOptions{}, context);
}

TEST(FeatureSize, LeavesRoomySurfacesAlone) {
  for (const double h : lengths(test::icosphere(4), 0.2)) EXPECT_DOUBLE_EQ(h, 0.2);
  for (const double h : lengths(test::box(12), 0.1)) EXPECT_DOUBLE_EQ(h, 0.1);
}

TEST(FeatureSize, GivesWayBetweenNearCurves) {
  // A flat box: its upper and lower edges are 0.2 apart, less than a quad edge.
  const TriangleMesh mesh = test::box(20, Vector3(4, 4, 0.2));
  const std::vector<double> h = lengths(mesh, 0.5);
  const FeatureSizeOptions options;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_LE(h[v], 0.5);
    EXPECT_GE(h[v], options.least_ratio * 0.5 - 1e-12);
    const Vector3& p = mesh.position(v);
    const bool on_rim = std::min({p[0], p[1], 4 - p[0], 4 - p[1]}) < 1e-9;
    if (on_rim) {
      EXPECT_LT(h[v], 0.35) << p.transpose();
    }
  }
}

TEST(FeatureSize, GrowsNoFasterThanAllowed) {
  const TriangleMesh mesh = test::box(20, Vector3(4, 4, 0.2));
  const std::vector<double> h = lengths(mesh, 0.5);
  for (int e = 0; e < mesh.halfedge_count(); ++e)
    EXPECT_LE(h[mesh.to(e)], h[mesh.from(e)] + FeatureSizeOptions{}.growth * mesh.edge_length(e) + 1e-12);
}

TEST(FeatureSize, GivesTubesRoomForFourQuadsAround) {
  constexpr double kRadius = 0.1, kLength = 0.25;
  const TriangleMesh tube = test::open_cylinder(24, 60, kRadius, 4);
  const std::vector<double> h = lengths(tube, kLength);
  for (int v = 0; v < tube.vertex_count(); ++v) {
    if (std::abs(tube.position(v)[2]) > 1.5) continue;
    // Without the limit it would be 1; between probes the length may grow a little.
    EXPECT_LT(4 * h[v], 2 * 3.15 * kRadius * 1.45);
    EXPECT_GT(h[v], 0.5 * kLength);
  }
}

TEST(FeatureSize, LetsChordsFollowBends) {
  constexpr double kRadius = 1, kLength = 1;
  const TriangleMesh tube = test::open_cylinder(60, 60, kRadius, 12);
  const std::vector<double> h = lengths(tube, kLength);
  int on_rim = 0, inside = 0;
  for (int v = 0; v < tube.vertex_count(); ++v) {
    const double from_rim = std::min(tube.position(v)[2], 12 - tube.position(v)[2]);
    if (from_rim < 0.01) {
      EXPECT_LT(h[v] * h[v] / (8 * kRadius), 0.07 * kLength);  // how far a chord of that length is from the circle
      EXPECT_GE(h[v], 0.6 * kLength);
      ++on_rim;
    } else if (from_rim > 3) {
      EXPECT_DOUBLE_EQ(h[v], kLength);
      ++inside;
    }
  }
  EXPECT_EQ(on_rim, 120);
  EXPECT_GT(inside, 0);
  // A curve that bends less than a chord shows is left alone.
  for (const double length : lengths(test::open_cylinder(60, 20, 10, 4), kLength)) EXPECT_DOUBLE_EQ(length, kLength);
}

TEST(FeatureSize, CountsQuads) {
  const TriangleMesh mesh = test::flat_grid(10, 10, 3, 2);
  EXPECT_NEAR(quads_for_lengths(mesh, std::vector<double>(mesh.vertex_count(), 0.1)), 600, 1e-6);
}

TEST(FeatureSize, GradingAsksWhetherToGoOn) {
  const TriangleMesh mesh = test::icosphere(7);
  RunContext context;
  context.stop_requested = [] { return true; };
  std::vector<double> length(mesh.vertex_count(), 1.0);
  EXPECT_THROW(grade_lengths(mesh, 2, length, 0.1, context), Cancelled);
}

}  // namespace
}  // namespace hybrid_quad
