#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/limit_surface.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "support/meshes.h"
#include "support/quad_complexes.h"

namespace hybrid_quad {
namespace {

RemeshResult fitted(const TriangleMesh& surface, int quads, bool fit, PlaneSet planes = 0, int threads = 1) {
  RemeshOptions options;
  options.quads = quads;
  options.fit_limit_surface = fit;
  options.symmetry.planes = planes;
  RunContext context;
  context.threads = threads;
  return remesh(test::soup_of(surface), options, context);
}

/// One step of Catmull and Clark's rules on a closed mesh without creases.
QuadMesh subdivided(const QuadMesh& mesh) {
  QuadMesh fine;
  const int vertices = static_cast<int>(mesh.positions.size()), quads = static_cast<int>(mesh.quads.size());
  std::map<std::array<int, 2>, std::vector<int>> quads_of_edge;
  std::vector<Vector3> middle(quads), of_faces(vertices, Vector3::Zero()), of_edges(vertices, Vector3::Zero());
  std::vector<int> valence(vertices, 0);
  for (int q = 0; q < quads; ++q) {
    const auto& v = mesh.quads[q];
    middle[q] = 0.25 * (mesh.positions[v[0]] + mesh.positions[v[1]] + mesh.positions[v[2]] + mesh.positions[v[3]]);
    for (int i = 0; i < 4; ++i) {
      ++valence[v[i]];
      of_faces[v[i]] += middle[q];
      quads_of_edge[{std::min(v[i], v[(i + 1) % 4]), std::max(v[i], v[(i + 1) % 4])}].push_back(q);
    }
  }
  fine.positions.resize(vertices);
  std::map<std::array<int, 2>, int> point_of_edge;
  for (const auto& [ends, around] : quads_of_edge) {
    const Vector3 sum = mesh.positions[ends[0]] + mesh.positions[ends[1]];
    for (const int v : ends) of_edges[v] += 0.5 * sum;
    point_of_edge[ends] = static_cast<int>(fine.positions.size());
    fine.positions.push_back(0.25 * (sum + middle[around.at(0)] + middle[around.at(1)]));
  }
  for (int v = 0; v < vertices; ++v) {
    const double n = valence[v];
    fine.positions[v] = (of_faces[v] / n + 2 * of_edges[v] / n + (n - 3) * mesh.positions[v]) / n;
  }
  for (int q = 0; q < quads; ++q) {
    const int centre = static_cast<int>(fine.positions.size());
    fine.positions.push_back(middle[q]);
    const auto& v = mesh.quads[q];
    const auto edge = [&](int i) { return point_of_edge[{std::min(v[i], v[(i + 1) % 4]), std::max(v[i], v[(i + 1) % 4])}]; };
    for (int i = 0; i < 4; ++i) fine.quads.push_back({v[i], edge(i), centre, edge((i + 3) % 4)});
  }
  return fine;
}

double mean_radius_error(const QuadMesh& mesh) {
  double sum = 0;
  for (const Vector3& p : mesh.positions) sum += std::abs(p.norm() - 1);
  return sum / static_cast<double>(mesh.positions.size());
}

std::vector<LimitPlace> places_on(int quads) {
  std::vector<LimitPlace> places;
  for (int q = 0; q < quads; ++q)
    for (const double u : {0.0, 0.3, 1.0})
      for (const double v : {0.1, 0.5}) places.push_back({q, u, v});
  return places;
}

TEST(LimitSurface, WeightsSumToOneAndKeepPlanes) {
  QuadMesh sheet = to_quad_mesh(test::quad_grid(4, 3));
  const SparseMatrix weights = limit_weights(sheet, places_on(12), RunContext{});
  const Eigen::VectorXd sums = weights * Eigen::VectorXd::Ones(weights.cols());
  EXPECT_NEAR(sums.minCoeff(), 1, 1e-12);
  EXPECT_NEAR(sums.maxCoeff(), 1, 1e-12);
  Eigen::VectorXd slope(weights.cols());
  for (Eigen::Index v = 0; v < slope.size(); ++v) slope[v] = 2 * sheet.positions[v].x() + 3 * sheet.positions[v].y();
  const Eigen::VectorXd at = weights * slope;
  const int inner = 6 * 5;  // places of quad (1, 1), which no boundary curve bends
  EXPECT_NEAR(at[inner], 2 * 1 + 3 * 1.1, 1e-12);
  EXPECT_NEAR(at[inner + 3], 2 * 1.3 + 3 * 1.5, 1e-12);
}

TEST(LimitSurface, IsWhatSubdivisionTendsTo) {
  const QuadMesh box = to_quad_mesh(test::quad_box(2, 2, 2));
  QuadMesh fine = box;
  for (int level = 0; level < 6; ++level) fine = subdivided(fine);
  std::vector<LimitPlace> corners;
  for (int q = 0; q < 24; ++q) corners.push_back({q, 0, 0});
  const SparseMatrix weights = limit_weights(box, corners, RunContext{});
  for (int q = 0; q < 24; ++q) {
    Vector3 at = Vector3::Zero();
    for (int v = 0; v < weights.cols(); ++v) at += weights.coeff(q, v) * box.positions[v];
    EXPECT_NEAR((at - fine.positions[box.quads[q][0]]).norm(), 0, 2e-3) << "vertices keep their numbers";
  }
}

TEST(LimitSurface, CornersAndCreasesAreSharp) {
  QuadMesh box = to_quad_mesh(test::quad_box(3, 3, 3));
  std::map<std::array<int, 2>, int> seen;
  const auto sides_at = [&](int v) {
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) count += box.positions[v][axis] == 0 || box.positions[v][axis] == 3;
    return count;
  };
  std::vector<LimitPlace> places;
  std::vector<Vector3> expected;
  for (std::size_t v = 0; v < box.positions.size(); ++v)
    if (sides_at(static_cast<int>(v)) == 3) box.kind[v] = VertexKind::kCorner;
  for (int q = 0; q < static_cast<int>(box.quads.size()); ++q)
    for (int i = 0; i < 4; ++i) {
      const int a = box.quads[q][i], b = box.quads[q][(i + 1) % 4];
      if (sides_at(a) < 2 || sides_at(b) < 2) continue;
      int same = 0;
      for (int axis = 0; axis < 3; ++axis) same += box.positions[a][axis] == box.positions[b][axis];
      if (same < 2 || !seen.emplace(std::array<int, 2>{std::min(a, b), std::max(a, b)}, q).second) continue;
      box.feature_edges.push_back({a, b, 0});
      places.push_back(place_on_side(q, i, 0.4));
      places.push_back(place_on_side(q, i, 0.0));
    }
  ASSERT_EQ(box.feature_edges.size(), 36u);
  const SparseMatrix weights = limit_weights(box, places, RunContext{});
  for (std::size_t i = 0; i < places.size(); ++i) {
    Vector3 at = Vector3::Zero();
    for (int v = 0; v < weights.cols(); ++v) at += weights.coeff(static_cast<int>(i), v) * box.positions[v];
    int on = 0;
    for (int axis = 0; axis < 3; ++axis) on += std::abs(at[axis]) < 1e-12 || std::abs(at[axis] - 3) < 1e-12;
    EXPECT_GE(on, 2) << "limit curves of the box's edges are its edges";
  }
}

TEST(FitLimitSurface, SphereIsMetByWhatSubdivisionMakesOfTheQuads) {
  const TriangleMesh sphere = test::icosphere(4);
  const QuadMesh before = fitted(sphere, 300, false).mesh;
  const RemeshResult after = fitted(sphere, 300, true);
  ASSERT_TRUE(after.report.limit_fit.is_fitted);
  EXPECT_LT(after.report.limit_fit.after.mean, 0.1 * after.report.limit_fit.before.mean);
  EXPECT_LT(after.report.limit_fit.after.largest, after.report.limit_fit.before.largest);
  const double was = mean_radius_error(subdivided(subdivided(subdivided(before))));
  const double is = mean_radius_error(subdivided(subdivided(subdivided(after.mesh))));
  EXPECT_LT(is, 0.25 * was) << "by rules written down here, not by OpenSubdiv";
  EXPECT_EQ(before.quads, after.mesh.quads);
  EXPECT_TRUE(violations_of(after.mesh).empty());
}

TEST(FitLimitSurface, CornersStayAndFlatSidesStayFlat) {
  const TriangleMesh box = test::box(4, Vector3(1, 2, 0.5));
  const RemeshResult result = fitted(box, 300, true);
  int corners = 0;
  for (std::size_t v = 0; v < result.mesh.positions.size(); ++v) {
    if (result.mesh.kind[v] != VertexKind::kCorner) continue;
    ++corners;
    const Vector3& p = result.mesh.positions[v];
    for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(p[axis] == 0 || p[axis] == Vector3(1, 2, 0.5)[axis]) << p.transpose();
  }
  EXPECT_EQ(corners, 8);
  EXPECT_LE(result.report.limit_fit.after.mean, result.report.limit_fit.before.mean) << "zero, but for rounding";
  EXPECT_LT(result.report.limit_fit.after.largest, 1e-9);
}

TEST(FitLimitSurface, CreasesFollowCurvedFeatures) {
  const TriangleMesh cylinder = test::capped_cylinder(96, 24);
  const RemeshResult result = fitted(cylinder, 400, true);
  EXPECT_LT(result.report.limit_fit.after.mean, 0.25 * result.report.limit_fit.before.mean);
  ASSERT_FALSE(result.mesh.feature_edges.empty());
  const SurfaceIndex index(cylinder, {});
  EXPECT_TRUE(inverted_quads(result.mesh, index).empty());
  EXPECT_GT(result.report.scaled_jacobian_min, 0.2);
  // A curve of creases is a cubic B-spline; at its vertices it is (1, 4, 1) / 6 of the chain.
  std::map<int, std::vector<int>> beside;
  for (const QuadMesh::FeatureEdge& e : result.mesh.feature_edges) {
    beside[e.a].push_back(e.b);
    beside[e.b].push_back(e.a);
  }
  for (const auto& [v, ends] : beside) {
    ASSERT_EQ(ends.size(), 2u);
    const auto& p = result.mesh.positions;
    const Vector3 limit = (4 * p[v] + p[ends[0]] + p[ends[1]]) / 6;
    EXPECT_NEAR(std::hypot(limit.x(), limit.y()), 1, 2e-3);
    EXPECT_GT(std::hypot(p[v].x(), p[v].y()), 1) << "the chain itself lies outside";
  }
}

TEST(FitLimitSurface, MirrorImagesStayExact) {
  const RemeshResult result = fitted(test::torus(48, 24), 400, true, plane(0));
  std::map<std::array<double, 3>, int> places;
  for (const Vector3& p : result.mesh.positions) ++places[{p.x() + 0.0, p.y(), p.z()}];
  for (const Vector3& p : result.mesh.positions) EXPECT_TRUE(places.count({0.0 - p.x(), p.y(), p.z()})) << p.transpose();
  EXPECT_LT(result.report.limit_fit.after.mean, 0.25 * result.report.limit_fit.before.mean);
}

TEST(FitLimitSurface, SameForAnyNumberOfThreads) {
  const TriangleMesh torus = test::torus(40, 20);
  const RemeshResult one = fitted(torus, 300, true, 0, 1), four = fitted(torus, 300, true, 0, 4);
  EXPECT_EQ(one.mesh.positions, four.mesh.positions);
  EXPECT_EQ(one.report.limit_fit.after.mean, four.report.limit_fit.after.mean);
}

TEST(FitLimitSurface, CornersAloneStay) {
  QuadMesh box = to_quad_mesh(test::quad_box(1, 1, 1));
  box.kind.assign(8, VertexKind::kCorner);
  const std::vector<Vector3> before = box.positions;
  const TriangleMesh surface = test::icosphere(3);
  fit_limit_surface(box, SurfaceIndex(surface, {}), {}, RunContext{});
  EXPECT_EQ(box.positions, before);
}

TEST(FitLimitSurface, NoQuadGetsInvertedAroundTightBends) {
  const TriangleMesh thin = test::torus(64, 12, 1, 0.03);  // about two quads around
  const RemeshResult before = fitted(thin, 120, false), after = fitted(thin, 120, true);
  const SurfaceIndex index(thin, {});
  EXPECT_TRUE(violations_of(after.mesh).empty());
  EXPECT_LE(inverted_quads(after.mesh, index).size(), inverted_quads(before.mesh, index).size());
  EXPECT_GE(after.report.scaled_jacobian_min, std::min(0.3, before.report.scaled_jacobian_min - 0.02) - 1e-9);
}

TEST(FitLimitSurface, NothingMovesUnlessAsked) {
  const TriangleMesh torus = test::torus(40, 20);
  EXPECT_FALSE(fitted(torus, 300, false).report.limit_fit.is_fitted);
}

}  // namespace
}  // namespace hybrid_quad
