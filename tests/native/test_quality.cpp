#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/mesh/segment_index.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

/// n x n squares over [0, 1]^2 at height z.
QuadMesh square_grid(int n, double z) {
  QuadMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      mesh.positions.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n, z);
      mesh.kind.push_back(VertexKind::kFree);
      mesh.anchor.push_back(0);
      mesh.near_face.push_back(-1);
    }
  const auto id = [n](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) mesh.quads.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
  return mesh;
}

TEST(ScaledJacobian, KnownQuads) {
  const Vector3 a(0, 0, 0), b(1, 0, 0), c(1, 1, 0), d(0, 1, 0);
  EXPECT_DOUBLE_EQ(scaled_jacobian(a, b, c, d), 1.0);
  EXPECT_NEAR(scaled_jacobian(a, 5 * b, Vector3(5, 1, 0), d), 1.0, 1e-15);
  const double angle = 60 * M_PI / 180;
  const Vector3 shear(std::cos(angle), std::sin(angle), 0);
  EXPECT_NEAR(scaled_jacobian(a, b, b + shear, shear), std::sin(angle), 1e-15);
  EXPECT_LT(scaled_jacobian(a, b, Vector3(0.2, 0.2, 0), d), 0.0) << "a corner of more than 180 degrees";
  EXPECT_DOUBLE_EQ(scaled_jacobian(a, a, a, a), -1.0);
}

TEST(ShapeQuality, RegularGridIsPerfect) {
  const ShapeQuality quality = shape_quality(square_grid(5, 0));
  EXPECT_NEAR(quality.scaled_jacobian_mean, 1.0, 1e-12);
  EXPECT_NEAR(quality.scaled_jacobian_min, 1.0, 1e-12);
  EXPECT_EQ(quality.below_zero, 0);
  EXPECT_EQ(quality.irregular_vertices, 0);
}

TEST(ShapeQuality, PoorIsAScaledJacobianBelowAFifth) {
  for (const auto& [sine, poor] : {std::pair{0.19, 16}, std::pair{0.21, 0}}) {
    QuadMesh mesh = square_grid(4, 0);
    for (Vector3& p : mesh.positions) p = Vector3(p.x() + std::sqrt(1 - sine * sine) * p.y(), sine * p.y(), 0);
    EXPECT_EQ(shape_quality(mesh).poor, poor);
    EXPECT_EQ(shape_quality(mesh).below_zero, 0);
  }
}

TEST(ShapeQuality, PercentileInterpolatesLikeNumpy) {
  QuadMesh mesh = square_grid(10, 0);
  mesh.positions[5 * 11 + 5] += Vector3(0.03, 0.03, 0);  // four quads change, the rest stay at one
  const ShapeQuality quality = shape_quality(mesh);
  EXPECT_GT(quality.scaled_jacobian_p1, quality.scaled_jacobian_min);
  EXPECT_LT(quality.scaled_jacobian_p1, 1.0);
}

TEST(InvertedQuads, FlippedQuadIsFoundAndThinSheetIsNot) {
  const TriangleMesh plate = test::box(4, Vector3(1, 1, 0.001));
  const SurfaceIndex index(plate, {});
  QuadMesh mesh = square_grid(4, 0.001);
  EXPECT_TRUE(inverted_quads(mesh, index).empty());
  for (auto& p : mesh.positions) p.z() = 0.0004;  // now nearer to the lower side, which looks the other way
  EXPECT_TRUE(inverted_quads(mesh, index).empty());
  const TriangleMesh sheet = test::flat_grid(4, 4);
  const SurfaceIndex one_side(sheet, {});
  std::swap(mesh.quads[3][1], mesh.quads[3][3]);
  EXPECT_EQ(inverted_quads(mesh, one_side), std::vector<int>{3});
}

TEST(InvertedQuads, ASliverThatAgreesIsNotEnough) {
  // A sheet that looks down, and above it a sliver that looks up, whose end comes near a quad that looks up, too.
  const std::array<Vector3, 4> quad{Vector3(1.5, 1.5, 0), Vector3(2.5, 1.5, 0), Vector3(2.5, 2.5, 0), Vector3(1.5, 2.5, 0)};
  const auto with_sliver = [&](double width) {
    std::vector<Vector3> points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2.2, 2, 0.01}, {3.8, 2, 0.01}, {3.8, 2 + width, 0.01}};
    return TriangleMesh(points, {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}});
  };
  const SurfaceIndex sliver(with_sliver(1e-4), {}), wide(with_sliver(0.8), {});
  constexpr double kEnough = 1e-4;
  EXPECT_TRUE(is_inverted(quad, sliver, {kEnough}));
  EXPECT_FALSE(is_inverted(quad, sliver)) << "whatever agrees";
  EXPECT_FALSE(is_inverted(quad, wide, {kEnough}));
}

TEST(InvertedQuads, HoweverSmallBesideItsPlace) {
  const std::vector<Vector3> points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  const SurfaceIndex index(TriangleMesh(points, {{0, 2, 1}, {0, 3, 2}}), {});
  for (const double size : {1e-3, 1e-5, 1e-7}) {
    const std::array<Vector3, 4> quad{Vector3(1, 3, 0), Vector3(1 + size, 3, 0), Vector3(1 + size, 3 + size, 0), Vector3(1, 3 + size, 0)};
    EXPECT_TRUE(is_inverted(quad, index)) << size;
  }
}

TEST(InvertedQuads, OneOfTwoSheetsInOnePlaceAgrees) {
  const std::vector<Vector3> points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  const SurfaceIndex index(TriangleMesh(points, {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}}), {});
  const auto square = [](double size) {
    return std::array<Vector3, 4>{Vector3(1, 2, 0), Vector3(1 + size, 2, 0), Vector3(1 + size, 2 + size, 0), Vector3(1, 2 + size, 0)};
  };
  constexpr double kEnough = 1e-3;
  EXPECT_FALSE(is_inverted(square(0.5), index, {kEnough}));
  EXPECT_TRUE(is_inverted(square(0.01), index, {kEnough})) << "with either sheet as the nearest, too little of the other is near";
  EXPECT_FALSE(is_inverted(square(0.01), index, {kEnough, true}));
}

TEST(InvertedQuads, TheEdgeOfASheetInThePlaceOfAnotherIsNoExcuse) {
  // Of the sheet that agrees, a strip as wide as `width` lies over the other one, under the middle of the quad.
  const auto strip_over_sheet = [](double width) {
    const double left = 2 - width / 2, right = 2 + width / 2;
    const std::vector<Vector3> points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {left, 0, 0}, {right, 0, 0}, {right, 4, 0}, {left, 4, 0}};
    return TriangleMesh(points, {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}});
  };
  const std::array<Vector3, 4> quad{Vector3(1.99, 1, 0), Vector3(2.01, 1, 0), Vector3(2.01, 1.02, 0), Vector3(1.99, 1.02, 0)};
  const SurfaceIndex narrow(strip_over_sheet(0.001), {}), wide(strip_over_sheet(0.02), {});
  constexpr double kEnough = 1e-3;
  EXPECT_TRUE(is_inverted(quad, narrow, {kEnough, true}));
  EXPECT_FALSE(is_inverted(quad, wide, {kEnough, true}));
}

TEST(InvertedQuads, WhereTheSearchBeginsMakesNoDifference) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (const TriangleMesh& surface : {test::torus(24, 12), test::box(6, Vector3(1, 1, 0.02))}) {
    const SurfaceIndex index(surface, {});
    const double area = surface.total_area();
    std::uniform_int_distribution<int> any_face(0, surface.face_count() - 1);
    std::array<int, 2> counts{0, 0};
    for (int i = 0; i < 400; ++i) {
      // Near a vertex, and turned any way.
      const Vector3 near = surface.position(surface.face(any_face(random))[0]);
      std::array<Vector3, 4> quad;
      for (int k = 0; k < 4; ++k) quad[k] = near + 0.02 * Vector3(u(random), u(random), u(random));
      const double size = 0.2 * (1.1 + u(random));
      const Vector3 x = size * Vector3(u(random), u(random), u(random)), y = size * Vector3(u(random), u(random), u(random));
      quad[1] += x;
      quad[2] += x + y;
      quad[3] += y;
      for (const Agreement& agreement : {Agreement{}, Agreement{1e-3 * area}, Agreement{1e-2 * area, true}}) {
        const bool expected = is_inverted(quad, index, agreement);
        ++counts[expected];
        for (int start = 0; start < 4; ++start) {
          Lookup lookup{any_face(random)};
          EXPECT_EQ(is_inverted(quad, index, agreement, &lookup), expected);
        }
      }
    }
    EXPECT_GT(std::min(counts[0], counts[1]), 100) << "both answers occur";
  }
}

TEST(FlawedQuads, WhoAsksForMoreFindsMore) {
  // Crumpled, so that all kinds of agreement occur.
  const SurfaceIndex index(test::torus(24, 12), {});
  QuadMesh mesh = square_grid(12, 0);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-0.2, 0.2);
  for (Vector3& p : mesh.positions) p = Vector3(3 * p.x() - 1.5, 3 * p.y() - 1.5, p.z()) + Vector3(u(random), u(random), u(random));
  const double area = index.mesh().total_area();
  std::vector<int> more;
  for (const Agreement& agreement : {Agreement{1e-2 * area}, Agreement{1e-3 * area}, Agreement{1e-3 * area, true}, Agreement{}}) {
    const std::vector<int> found = flawed_quads(mesh, index, agreement);
    EXPECT_FALSE(found.empty());
    if (!more.empty()) {
      EXPECT_EQ(flawed_among(more, mesh, index, agreement), found);
    }
    more = found;
  }
}

TEST(FlawedQuads, ANeedleMayFillTheSheetThatItLiesOn) {
  // A narrow strip, face up, on a sheet that lies face down.
  const double width = 0.01;
  const SurfaceIndex index(TriangleMesh({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-0.9, 0, 0}, {0.9, 0, 0}, {0.9, width, 0}, {-0.9, width, 0}},
                                        {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}}), {});
  const auto strip = [](double low, double high) {
    return std::array<Vector3, 4>{Vector3(-0.1, low, 0), Vector3(0.2, low, 0), Vector3(0.2, high, 0), Vector3(-0.1, high, 0)};
  };
  const Agreement agreement{1, true};
  EXPECT_FALSE(is_inverted(strip(0, width), index, agreement));
  EXPECT_TRUE(is_inverted(strip(2 * width, 3 * width), index, agreement)) << "beside the strip, against the sheet";
  EXPECT_TRUE(is_inverted(strip(-0.15, 0.15 + width), index, agreement)) << "the strip is a small part of what is below";
}

TEST(SurfaceDistance, ParallelSheets) {
  const TriangleMesh sheet = test::flat_grid(6, 6);
  const SurfaceIndex index(sheet, {});
  RunContext context;
  const SurfaceDistance distance = surface_distance(square_grid(3, 0.1), index, context);
  const double expected = 100 * 0.1 / std::sqrt(2.0);
  EXPECT_NEAR(distance.mean, expected, 1e-9);
  EXPECT_NEAR(distance.hausdorff(), expected, 1e-9);
  const SurfaceDistance zero = surface_distance(square_grid(3, 0), index, context);
  EXPECT_NEAR(zero.hausdorff(), 0.0, 1e-12);
}

TEST(SurfaceDistance, SameForAnyNumberOfThreads) {
  const TriangleMesh sphere = test::icosphere(4);
  const SurfaceIndex index(sphere, {});
  QuadMesh mesh = square_grid(12, 0.3);
  RunContext context;
  const SurfaceDistance one = surface_distance(mesh, index, context, 20000);
  for (const int threads : {2, 3, 4}) {
    context.threads = threads;
    const SurfaceDistance many = surface_distance(mesh, index, context, 20000);
    EXPECT_EQ(one.mean, many.mean);
    EXPECT_EQ(one.quads_to_input_max, many.quads_to_input_max);
    EXPECT_EQ(one.input_to_quads_max, many.input_to_quads_max);
  }
}

TEST(SurfaceDistance, TwoQuadsMayShareADiagonal) {
  // Vertex pairs alone would glue the wrong triangles here.
  QuadMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.3}, {0, 1, 0}, {0.2, 0.9, 0.2}, {0.9, 0.2, 0.4}};
  mesh.quads = {{0, 1, 2, 3}, {0, 3, 2, 4}, {0, 4, 2, 5}, {0, 5, 2, 1}};
  mesh.kind.assign(6, VertexKind::kFree);
  mesh.anchor.assign(6, 0);
  mesh.near_face.assign(6, -1);
  const TriangleMesh sheet = test::flat_grid(2, 2);
  const SurfaceIndex index(sheet, {});
  EXPECT_NO_THROW(surface_distance(mesh, index, RunContext{}, 1000));
}

TEST(FeatureDistance, BoundaryOfASquare) {
  const TriangleMesh sheet = test::flat_grid(4, 4);
  const FeatureGraph features = trace_features(sheet, std::vector<char>(sheet.halfedge_count(), 0));
  QuadMesh mesh = square_grid(4, 0);
  EXPECT_EQ(feature_distance(mesh, sheet, features, RunContext{}), 100.0);
  for (int i = 0; i < 4; ++i) {
    mesh.feature_edges.push_back({i, i + 1, 0});
    mesh.feature_edges.push_back({20 + i + 1, 20 + i, 0});
    mesh.feature_edges.push_back({5 * (i + 1), 5 * i, 0});
    mesh.feature_edges.push_back({5 * i + 4, 5 * i + 9, 0});
  }
  EXPECT_NEAR(feature_distance(mesh, sheet, features, RunContext{}), 0.0, 1e-9);
  mesh.positions[2].y() += 0.1;
  const double to_slope = 0.1 * 0.25 / std::hypot(0.1, 0.25);
  EXPECT_NEAR(feature_distance(mesh, sheet, features, RunContext{}), 100 * to_slope / std::sqrt(2.0), 0.05);
}

TEST(SegmentIndex, AgreesWithTryingAll) {
  std::vector<std::array<Vector3, 2>> segments;
  for (int i = 0; i < 300; ++i) {
    const double t = 0.1 * i;
    segments.push_back({Vector3(std::cos(t), std::sin(2 * t), 0.01 * t), Vector3(std::cos(t + 0.1), std::sin(2 * t + 0.2), 0.01 * t)});
  }
  segments.push_back({Vector3::Zero(), Vector3::Zero()});
  const SegmentIndex index(segments);
  for (int i = 0; i < 200; ++i) {
    const Vector3 p(std::sin(3.1 * i), std::cos(1.7 * i), std::sin(0.3 * i));
    double least = 1e300;
    for (const auto& s : segments) {
      const Vector3 d = s[1] - s[0];
      const double t = d.squaredNorm() > 0 ? std::min(1.0, std::max(0.0, (p - s[0]).dot(d) / d.squaredNorm())) : 0.0;
      least = std::min(least, (s[0] + t * d - p).squaredNorm());
    }
    EXPECT_NEAR(index.nearest(p).squared_distance, least, 1e-15);
  }
  EXPECT_EQ(SegmentIndex({}).nearest(Vector3::Zero()).segment, -1);
}

}  // namespace
}  // namespace hybrid_quad
