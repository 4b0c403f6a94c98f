#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/working_surface/working_surface.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

struct Remeshed {
  FeatureGraph features;
  WorkingSurface surface;
};

Remeshed remesh(const TriangleMesh& input, double h) {
  Remeshed r;
  r.features = detect_features(input, FeatureOptions{}, RunContext{});
  r.surface = build_working_surface(input, r.features, std::vector<double>(input.vertex_count(), h), {}, RunContext{});
  const auto violations = violations_of(r.surface, input, r.features);
  EXPECT_TRUE(violations.empty()) << violations.front();
  return r;
}

/// The smallest angle of every face in degrees, sorted.
std::vector<double> smallest_angles(const TriangleMesh& m) {
  std::vector<double> angles;
  for (int f = 0; f < m.face_count(); ++f) {
    double least = 180;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const Vector3 a = m.edge_vector(h), b = -m.edge_vector(TriangleMesh::previous(h));
      least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / 3.14159265358979);
    }
    angles.push_back(least);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

double farthest_from(const TriangleMesh& m, const TriangleMesh& points) {
  const SurfaceIndex index(m, {});
  double d2 = 0;
  for (const Vector3& p : points.positions()) d2 = std::max(d2, index.nearest(p).squared_distance);
  return std::sqrt(d2);
}

TEST(WorkingSurface, CoarseBoxGetsWellShapedTriangles) {
  for (const int n : {1, 2, 7}) {
    const TriangleMesh input = test::box(n, Vector3(1, 2, 3));
    const double h = 0.15;
    const WorkingSurface w = remesh(input, h).surface;
    EXPECT_NEAR(w.mesh.total_area(), input.total_area(), 1e-9);
    EXPECT_GT(smallest_angles(w.mesh).front(), 20);
    for (int k = 0; k < w.mesh.halfedge_count(); ++k) {
      EXPECT_LE(w.mesh.edge_length(k), 1.35 * WorkingSurfaceOptions{}.edge_fraction * h);
      if (w.features.is_feature(k)) {
        EXPECT_LE(w.mesh.edge_length(k), 0.5001 * h);
      }
    }
  }
}

TEST(WorkingSurface, DenseSphereIsCoarsenedAndStaysASphere) {
  const TriangleMesh input = test::icosphere(5);
  const double h = 0.2;
  const WorkingSurface w = remesh(input, h).surface;
  const double faces_per_quad = w.mesh.face_count() / (input.total_area() / (h * h));
  const double edge = WorkingSurfaceOptions{}.edge_fraction;
  const double even = 4 / (std::sqrt(3.0) * edge * edge);  // equilateral triangles
  EXPECT_GT(faces_per_quad, 0.8 * even);
  EXPECT_LT(faces_per_quad, 1.5 * even);
  EXPECT_GT(smallest_angles(w.mesh)[w.mesh.face_count() / 100], 25);
  EXPECT_LT(farthest_from(input, w.mesh), 1e-9);
  EXPECT_LT(farthest_from(w.mesh, input), 0.1 * h);
}

TEST(WorkingSurface, NeedleCapsBecomeRegular) {
  const TriangleMesh input = test::capped_cylinder(400, 1);
  const WorkingSurface w = remesh(input, 0.15).surface;
  EXPECT_GT(smallest_angles(w.mesh)[w.mesh.face_count() / 100], 15);
  EXPECT_LT(farthest_from(input, w.mesh), 0.06 * 0.15);
}

/// The mesh with two vertices in the place of from(h), and where the edge h was between them and to(h) a fin of two coinciding faces
/// whose third corner is `tip`: the edge between the two cannot be collapsed as long as the fin is there.
TriangleMesh with_fin(const TriangleMesh& m, int h, const Vector3& tip) {
  std::vector<Vector3> positions = m.positions();
  std::vector<std::array<int, 3>> faces = m.faces();
  const int a = m.from(h), w = m.to(h), b = m.vertex_count(), z = b + 1;
  positions.push_back(m.position(a));
  positions.push_back(tip);
  int k = h;
  for (int i = 0; i < 2; ++i, k = m.rotate_ccw(k)) faces[k / 3][k % 3] = b;
  faces.push_back({a, b, m.to(k)});
  faces.push_back({z, b, a});
  faces.push_back({z, a, w});
  faces.push_back({z, w, b});
  return TriangleMesh(std::move(positions), std::move(faces));
}

TEST(WorkingSurface, EdgesWithoutLengthAtFinsLeaveNoFaceWithoutArea) {
  const TriangleMesh box = test::box(2, Vector3(1, 1, 1));
  for (int h = 0; h < box.halfedge_count(); ++h) {
    const Vector3 along = box.edge_vector(h), n = box.area_normal(h / 3).normalized();
    if (n.dot(box.area_normal(box.opposite(h) / 3)) <= 0) continue;  // an edge of the box
    for (const double height : {1e-8, 1e-4, 0.1}) {
      SCOPED_TRACE("half-edge " + std::to_string(h) + ", height " + std::to_string(height));
      remesh(with_fin(box, h, box.position(box.from(h)) + 0.01 * along + height * n), 0.2);
    }
  }
}

TEST(WorkingSurface, FinsAtAnEdgeWithoutLengthGoWhereTheyAreNoFeature) {
  const TriangleMesh box = test::box(2, Vector3(1, 1, 1));
  int tried = 0, kept = 0;
  FeatureOptions no_angles;
  no_angles.use_sharp_angle = false;
  for (int h = 0; h < box.halfedge_count(); ++h) {
    const Vector3 along = box.edge_vector(h), n = box.area_normal(h / 3).normalized();
    if (n.dot(box.area_normal(box.opposite(h) / 3)) <= 0) continue;
    const TriangleMesh input = with_fin(box, h, box.position(box.from(h)) + 0.01 * along + 1e-4 * n);
    const FeatureGraph features = detect_features(input, no_angles, RunContext{});
    const WorkingSurface w =
        build_working_surface(input, features, std::vector<double>(input.vertex_count(), 0.2), {}, RunContext{});
    ++tried;
    kept += w.mesh.total_area() > box.total_area() * (1 + 1e-6);
  }
  EXPECT_LE(10 * kept, tried);
}

TEST(WorkingSurface, KeepsBoundariesAndTheirDirection) {
  const TriangleMesh input = test::open_cylinder(64, 20);
  const Remeshed r = remesh(input, 0.3);
  ASSERT_EQ(r.surface.features.curves.size(), 2u);
  for (int c = 0; c < 2; ++c) {
    const auto winding = [c](const FeatureGraph& g, const TriangleMesh& m) {
      double area = 0;
      const auto& v = g.curves[c].vertices;
      for (std::size_t i = 0; i + 1 < v.size(); ++i)
        area += m.position(v[i]).x() * m.position(v[i + 1]).y() - m.position(v[i]).y() * m.position(v[i + 1]).x();
      return area;
    };
    EXPECT_NEAR(winding(r.surface.features, r.surface.mesh), winding(r.features, input), 0.2);
  }
}

TEST(WorkingSurface, SurvivesAQuadSizeBeyondTheModel) {
  for (const TriangleMesh& input : {test::box(3), test::torus(12, 8), test::icosphere(2), test::flat_grid(6, 6),
                                    test::open_cylinder(16, 3), test::wedge(3, 100)})
    for (const double h : {0.5, 5.0, 500.0}) remesh(input, h);
}

TEST(WorkingSurface, SameInputSameResult) {
  const TriangleMesh input = test::torus(20, 10);
  const WorkingSurface a = remesh(input, 0.2).surface, b = remesh(input, 0.2).surface;
  EXPECT_EQ(a.mesh.positions(), b.mesh.positions());
  EXPECT_EQ(a.mesh.faces(), b.mesh.faces());
}

TEST(WorkingSurface, NeighboursAreNearInMemory) {
  const WorkingSurface w = remesh(test::torus(20, 10), 0.03).surface;
  std::vector<int> apart;
  for (int h = 0; h < w.mesh.halfedge_count(); ++h)
    if (w.mesh.opposite(h) >= 0) apart.push_back(std::abs(w.mesh.opposite(h) - h) / 3);
  std::sort(apart.begin(), apart.end());
  EXPECT_LT(apart[apart.size() * 9 / 10], 10 * std::sqrt(w.mesh.face_count()));
}

TEST(WorkingSurface, FollowsVaryingTargets) {
  const TriangleMesh input = test::flat_grid(20, 20, 10, 10);
  const FeatureGraph g = detect_features(input, FeatureOptions{}, RunContext{});
  std::vector<double> h(input.vertex_count());
  for (int v = 0; v < input.vertex_count(); ++v) h[v] = 0.2 + 0.1 * input.position(v).x();
  const WorkingSurface w = build_working_surface(input, g, h, {}, RunContext{});
  double fine = 0, coarse = 0;
  for (int f = 0; f < w.mesh.face_count(); ++f)
    (w.mesh.position(w.mesh.face(f)[0]).x() < 5 ? fine : coarse) += 1;
  EXPECT_GT(fine, 2 * coarse);
}

TEST(WorkingSurface, ModelsKeepTheirTopologyAndCurves) {
  const auto files = test::model_files();
  if (files.empty()) GTEST_SKIP();
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const TriangleMesh input = build_mesh(test::read_obj(file)).mesh;
    if (input.face_count() > 12000) continue;
    const Remeshed r = remesh(input, std::sqrt(input.total_area() / 500));
    EXPECT_TRUE(violations_of(r.features, input).empty());
  }
}

}  // namespace
}  // namespace hybrid_quad
