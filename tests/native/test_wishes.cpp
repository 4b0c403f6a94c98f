// What a caller asks of places: directions, densities, frames; and sizes and directions that follow the curvature.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hybrid_quad/frame_field/guide_map.h"
#include "hybrid_quad/frame_field/surface_curvature.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/sizing/asked_lengths.h"
#include "hybrid_quad/sizing/chord_lengths.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

using test::surface_of;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// Degrees from a vector to the nearest axis of a cross, in the plane of `normal`.
double degrees_between(const Vector3& d, const Vector3& axis, const Vector3& normal) {
  const Vector3 across = normal.cross(axis);
  const double x = std::abs(d.dot(axis)), y = std::abs(d.dot(across));
  return std::atan2(std::min(x, y), std::max(x, y)) * 180 / 3.14159265358979323846;
}

/// A direction on a surface about the origin that is neither a parallel nor a meridian.
Vector3 slanted(const Vector3& p, const Vector3& normal) {
  const Vector3 round = Vector3(0, 0, 1).cross(p), t = round - round.dot(normal) * normal;
  return (std::cos(0.5) * t + std::sin(0.5) * normal.cross(t)).normalized();
}

RemeshResult remeshed(const TriangleMesh& mesh, RemeshOptions options) {
  options.use_sharp_angle = false;
  return remesh(test::soup_of(mesh), options, RunContext{});
}

template <class Visit>
void visit_quad_edges(const QuadMesh& mesh, Visit visit) {
  for (const auto& q : mesh.quads)
    for (int i = 0; i < 4; ++i) visit(mesh.positions[q[i]], mesh.positions[q[(i + 1) & 3]]);
}

TEST(SurfaceCurvature, OfACylinderIsThatOfItsRadiusWhateverTheTriangles) {
  const double radius = 1;
  const WorkingSurface surface = surface_of(test::open_cylinder(64, 40, radius, 4), 0.2, 180);
  const std::vector<PrincipalCurvature> curvature = principal_curvatures(surface);
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    const Vector3 p = surface.mesh.position(surface.mesh.face(f)[0]);
    if (p.z() < 0.6 || p.z() > 3.4) continue;  // a margin at the open ends
    EXPECT_NEAR(curvature[f].strong, 1 / radius, 0.1);
    EXPECT_NEAR(curvature[f].weak, 0, 0.1);
    EXPECT_LT(std::abs(curvature[f].direction.z()), 0.1);
  }
}

TEST(SurfaceCurvature, OfASphereHasNoDirection) {
  const WorkingSurface surface = surface_of(test::icosphere(4, 2), 0.3, 180);
  for (const PrincipalCurvature& c : principal_curvatures(surface)) {
    EXPECT_NEAR(c.strong, 0.5, 0.05);
    EXPECT_LT(c.anisotropy(0.3), 0.03);
  }
}

TEST(GuideMap, QuarterTurnsAreTheSameAndWhatStandsUpIsWeak) {
  const TriangleMesh mesh = test::flat_grid(1, 1);
  const Vector3 g(0.8, 0.6, 0);
  const GuideMap map(mesh, {g, Vector3(-0.6, 0.8, 0), -g, g, g, Vector3(0, 0, 1)});
  const Vector3 at = map.at(0, Vector3(0.6, 0.3, 0));
  EXPECT_NEAR(at.norm(), 1, 1e-9);
  EXPECT_LT(degrees_between(at, g, Vector3(0, 0, 1)), 1e-6);
  EXPECT_LT(map.at(1, mesh.position(mesh.face(1)[2])).norm(), 1e-9);
}

TEST(FrameFieldGuides, AreFollowedWhereGivenAndOnlyThere) {
  const TriangleMesh mesh = test::torus(80, 40);
  const WorkingSurface surface = surface_of(mesh, 0.1, 180);
  FrameFieldOptions options;
  options.guides.assign(mesh.face_count(), Vector3::Zero());
  for (int f = 0; f < mesh.face_count(); ++f) {
    const Vector3 p = mesh.position(mesh.face(f)[0]);
    if (p.x() > 0) options.guides[f] = slanted(p, mesh.normal(f));
  }
  const FrameField field = solve_frame_field(surface, options, RunContext{});
  EXPECT_TRUE(violations_of(field, surface).empty());
  std::vector<double> errors;
  for (int f = 0; f < mesh.face_count(); ++f)
    if (options.guides[f].squaredNorm() > 0)
      errors.push_back(degrees_between(field.du[f], options.guides[f], mesh.normal(f)));
  EXPECT_LT(median(errors), 2);
}

TEST(FrameFieldGuides, FeaturesGoFirst) {
  const TriangleMesh mesh = test::flat_grid(20, 20);
  const WorkingSurface surface = surface_of(mesh, 0.08, 40);
  FrameFieldOptions options;
  options.guides.assign(mesh.face_count(), Vector3(std::sqrt(0.5), std::sqrt(0.5), 0));
  const FrameField field = solve_frame_field(surface, options, RunContext{});
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.is_boundary(h)) {
      EXPECT_LT(degrees_between(field.du[h / 3], mesh.edge_vector(h).normalized(), mesh.normal(h / 3)), 1e-3);
    }
}

TEST(FrameFieldCurvature, AxesTurnToThePrincipalDirections) {
  // A tube without ends to hold on to: nothing but its curvature tells directions apart.
  const TriangleMesh mesh = test::torus(90, 24, 1, 0.2);
  const WorkingSurface surface = surface_of(mesh, 0.08, 180);
  FrameFieldOptions options;
  options.curvature_alignment = 0.2;
  const FrameField field = solve_frame_field(surface, options, RunContext{});
  EXPECT_EQ(field.cone_count(), 0);
  for (int f = 0; f < mesh.face_count(); ++f) {
    const Vector3 round = Vector3(0, 0, 1).cross(mesh.position(mesh.face(f)[0])).normalized();
    EXPECT_LT(degrees_between(field.du[f], round, mesh.normal(f)), 8);
  }
}

TEST(Density, IsGradedAndNeverLowered) {
  const TriangleMesh mesh = test::flat_grid(40, 4, 10, 1);
  std::vector<double> density(mesh.vertex_count(), 0.5);
  density[0] = 4;
  const std::vector<double> before = density;
  grade_density(mesh, 1, 0.5, density, RunContext{});
  for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_GE(density[v], before[v]);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    EXPECT_LE(1 / density[mesh.to(h)], 1 / density[mesh.from(h)] + 0.5 * mesh.edge_length(h) + 1e-9);
  EXPECT_EQ(density[0], 4);
  EXPECT_GT(density[1], 1);
}

TEST(Density, ChangesLengthsWhereAskedAndKeepsTheCount) {
  const TriangleMesh mesh = test::torus(96, 40);
  RemeshOptions options;
  options.quads = 3000;
  for (const Vector3& p : mesh.positions()) options.density.push_back(p.x() > 0.3 ? 2 : 1);
  const RemeshResult result = remeshed(mesh, options);
  EXPECT_TRUE(violations_of(result.mesh).empty());
  EXPECT_NEAR(result.report.quads, 3000, 150);
  std::vector<double> fine, coarse;
  visit_quad_edges(result.mesh, [&](const Vector3& a, const Vector3& b) {
    if (a.x() > 0.5 && b.x() > 0.5) fine.push_back((a - b).norm());
    if (a.x() < -0.2 && b.x() < -0.2) coarse.push_back((a - b).norm());
  });
  EXPECT_NEAR(median(fine) / median(coarse), 0.5, 0.15 * 0.5);
}

TEST(Density, ScalesAGivenEdgeLength) {
  const TriangleMesh mesh = test::icosphere(4);
  RemeshOptions options;
  options.edge_length = 0.16;
  const int even = remeshed(mesh, options).report.quads;
  options.density.assign(mesh.vertex_count(), 2);
  EXPECT_NEAR(remeshed(mesh, options).report.quads, 4.0 * even, 0.3 * even);
  options.edge_length = 0;
  options.quads = even;
  EXPECT_NEAR(remeshed(mesh, options).report.quads, even, 0.08 * even);
}

TEST(Adaptivity, ShortensEdgesWhereTheSurfaceBendsMore) {
  // An egg with a sharp end at z > 0, of triangles that lie differently each time.
  const TriangleMesh sphere = test::icosphere(5);
  std::vector<TriangleMesh> eggs;
  for (const double turn : {0.0, 0.2, 0.4}) {
    std::vector<Vector3> positions = sphere.positions();
    for (Vector3& p : positions) {
      p = Eigen::AngleAxisd(turn, Vector3::UnitY()) * p;
      p = Vector3(p.x() * (1.2 - 0.8 * p.z()), p.y() * (1.2 - 0.8 * p.z()), 2.5 * p.z());
    }
    eggs.emplace_back(positions, sphere.faces());
  }
  // A row more or less around the tip is a fifth of it: nine meshes together.
  const auto tip_over_belly = [&](double adaptivity) {
    double ratios = 0;
    for (const TriangleMesh& egg : eggs)
      for (const int quads : {1500, 1800, 2200}) {
        RemeshOptions options;
        options.quads = quads;
        options.adaptivity = adaptivity;
        std::vector<double> tip, belly;
        visit_quad_edges(remeshed(egg, options).mesh, [&](const Vector3& a, const Vector3& b) {
          if (a.z() > 2.1) tip.push_back((a - b).norm());
          if (a.z() < 0) belly.push_back((a - b).norm());
        });
        ratios += median(tip) / median(belly);
      }
    return ratios / 9;
  };
  const double even = tip_over_belly(0), half = tip_over_belly(0.5), full = tip_over_belly(1);
  EXPECT_LT(half, 0.85 * even);
  EXPECT_LT(full, 0.9 * half);
}

/// Longer over shorter middle line of the quads, and whether the longer goes round the z axis, in the mean.
struct Stretch {
  double ratio = 0, round = 0;
};

Stretch stretch_of(const QuadMesh& mesh) {
  std::vector<double> ratios;
  double round = 0;
  for (const auto& q : mesh.quads) {
    const auto& p = mesh.positions;
    Vector3 u = p[q[1]] + p[q[2]] - p[q[0]] - p[q[3]], v = p[q[2]] + p[q[3]] - p[q[0]] - p[q[1]];
    if (u.norm() < v.norm()) std::swap(u, v);
    ratios.push_back(u.norm() / v.norm());
    const Vector3 axis = Vector3(0, 0, 1).cross(p[q[0]]).normalized();
    round += std::abs(u.normalized().dot(axis)) > 0.7;
  }
  return {median(ratios), round / static_cast<double>(mesh.quads.size())};
}

TEST(Anisotropy, StretchesAlongATubeButNotBeyondTheLimit) {
  const TriangleMesh tube = test::torus(160, 24, 2, 0.2);
  RemeshOptions options;
  options.quads = 1500;
  EXPECT_LT(stretch_of(remeshed(tube, options).mesh).ratio, 1.2);
  options.anisotropy = 2;
  const RemeshResult result = remeshed(tube, options);
  EXPECT_TRUE(violations_of(result.mesh).empty());
  const Stretch stretch = stretch_of(result.mesh);
  EXPECT_GT(stretch.ratio, 1.6);
  EXPECT_LT(stretch.ratio, 2.2);
  EXPECT_GT(stretch.round, 0.95);
}

TEST(CustomFrames, GiveTheirDirectionsAndLengths) {
  const TriangleMesh mesh = test::torus(120, 40, 1, 0.4);
  RemeshOptions options;
  options.quads = 2000;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vector3 round = Vector3(0, 0, 1).cross(mesh.position(v)).normalized();
    const Vector3 centre = Vector3(mesh.position(v).x(), mesh.position(v).y(), 0).normalized();
    const Vector3 across = (mesh.position(v) - centre).cross(round).normalized();
    options.vertex_frames.push_back({1.6 * round, 0.8 * across});
  }
  const RemeshResult result = remeshed(mesh, options);
  EXPECT_TRUE(violations_of(result.mesh).empty());
  const Stretch stretch = stretch_of(result.mesh);
  // Whole quads around and along the tube: some forty each, to be hit within a few of the asked count.
  EXPECT_NEAR(stretch.ratio, 2, 0.4);
  EXPECT_GT(stretch.round, 0.9);
  EXPECT_NEAR(result.report.quads, 2000, 160);
}

TEST(Guides, OutputEdgesFollowThem) {
  const TriangleMesh mesh = test::torus(96, 40);
  const SurfaceIndex index(mesh, {});
  RemeshOptions options;
  options.quads = 2500;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const Vector3 p = mesh.position(mesh.face(f)[0]);
    options.face_guides.push_back(p.x() > 0.2 ? slanted(p, mesh.normal(f)) : Vector3(0, 0, 0));
  }
  std::vector<double> errors;
  visit_quad_edges(remeshed(mesh, options).mesh, [&](const Vector3& a, const Vector3& b) {
    const Vector3 p = 0.5 * (a + b);
    if (p.x() < 0.4) return;
    const Vector3 normal = mesh.normal(index.nearest(p).face);
    errors.push_back(degrees_between(b - a, slanted(p, normal), normal));
  });
  EXPECT_LE(median(errors), 5);
}

TEST(Wishes, OfVerticesThatNoFaceUsesMakeNoDifference) {
  PolygonSoup soup = test::soup_of(test::icosphere(1));
  soup.positions.push_back(Vector3(9, 9, 9));
  RemeshOptions options;
  options.quads = 100;
  options.density.assign(soup.positions.size(), 1);
  options.density.back() = NAN;
  options.vertex_guides.assign(soup.positions.size(), Vector3::Zero());
  options.vertex_guides.back().x() = NAN;
  options.vertex_frames.assign(soup.positions.size(), {Vector3::Zero(), Vector3::Zero()});
  options.vertex_frames.back()[0].x() = NAN;
  EXPECT_GT(remesh(soup, options, RunContext{}).mesh.quads.size(), 0u);
}

TEST(Wishes, ThatMakeNoSenseAreRefusedByName) {
  const TriangleMesh mesh = test::icosphere(1);
  const auto code_of = [&](const RemeshOptions& options) {
    try {
      remesh(test::soup_of(mesh), options, RunContext{});
    } catch (const InputError& error) {
      return error.code + (error.elements.empty() ? "" : " " + std::to_string(error.elements.front()));
    }
    return std::string("taken");
  };
  RemeshOptions options;
  options.quads = 100;
  options.density.assign(mesh.vertex_count(), 1);
  options.density[7] = NAN;
  EXPECT_EQ(code_of(options), "non_finite_density 7");
  options.density.clear();
  options.marked_edges = {{0, mesh.vertex_count()}};
  EXPECT_EQ(code_of(options), "index_out_of_range " + std::to_string(mesh.vertex_count()));
  options.marked_edges.clear();
  options.density.resize(3);
  EXPECT_EQ(code_of(options), "wrong_count");
  options.density.clear();
  options.vertex_guides.assign(mesh.vertex_count(), Vector3(1, 0, 0));
  options.vertex_guides[5].z() = INFINITY;
  EXPECT_EQ(code_of(options), "non_finite_guide 5");
  options.vertex_guides.clear();
  options.vertex_frames.assign(mesh.vertex_count(), {Vector3(1, 0, 0), Vector3(0, 1, 0)});
  options.vertex_frames[4][1] = Vector3(2, 0, 0);
  EXPECT_EQ(code_of(options), "degenerate_frame 4");
}

/// Distances of the quads' middles to the surface, sorted.
std::vector<double> distances(const QuadMesh& mesh, const TriangleMesh& surface) {
  const SurfaceIndex index(surface, {});
  std::vector<double> found;
  for (const auto& q : mesh.quads) {
    const Vector3 middle = 0.25 * (mesh.positions[q[0]] + mesh.positions[q[1]] + mesh.positions[q[2]] + mesh.positions[q[3]]);
    found.push_back(std::sqrt(index.nearest(middle).squared_distance));
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(ChordError, OfASphereGivesTheLengthOfItsChords) {
  const TriangleMesh mesh = test::icosphere(5);
  ChordOptions options;
  options.error = 0.01;
  options.start = 0.2;
  options.least = 0.01;
  options.longest = 1;
  // Both curvatures are 1: the middle of a quad is l^2 / 4 below its corners.
  const FeatureGraph features = detect_features(mesh, FeatureOptions{}, RunContext{});
  for (const double l : chord_lengths(mesh, features, options, RunContext{})) EXPECT_NEAR(l, std::sqrt(4 * 0.01), 0.03);
}

TEST(ChordError, IsKeptByNearlyAllQuadsAndCostsWhatItMust) {
  const TriangleMesh mesh = test::torus(160, 80);
  int last = 0;
  for (const double error : {0.02, 0.005}) {
    RemeshOptions options;
    options.chord_error = error;
    const RemeshResult result = remeshed(mesh, options);
    const std::vector<double> found = distances(result.mesh, mesh);
    EXPECT_LE(found[found.size() * 95 / 100], error);
    EXPECT_GE(found[found.size() * 95 / 100], 0.15 * error);
    if (last > 0) {
      EXPECT_NEAR(static_cast<double>(result.report.quads) / last, 4, 1);  // a quarter of the error, half the length
    }
    last = result.report.quads;
  }
}

TEST(ChordError, TakesAGivenEdgeLengthForTheLongest) {
  const TriangleMesh mesh = test::icosphere(4);
  RemeshOptions options;
  options.chord_error = 0.5;
  options.edge_length = 0.2;
  const RemeshResult result = remeshed(mesh, options);
  EXPECT_NEAR(result.report.quads, mesh.total_area() / 0.04, 0.1 * mesh.total_area() / 0.04);
}

TEST(NarrowStrips, GetTheRowsThatAreAskedForAndAsManyQuads) {
  for (const double thickness : {0.1, 0.15, 0.2}) {
    const TriangleMesh plate = test::box(10, Vector3(4, 4, thickness));
    for (const int rows : {1, 2}) {
      RemeshOptions options;
      options.quads = 800;
      options.narrow_quads = rows;
      const RemeshResult result = remesh(test::soup_of(plate), options, RunContext{});
      EXPECT_EQ(result.report.flawed_quads, 0);
      EXPECT_NEAR(result.report.quads, 800, 80);
      std::vector<double> upright;
      visit_quad_edges(result.mesh, [&](const Vector3& a, const Vector3& b) {
        if (a.x() < 1e-9 && b.x() < 1e-9 && std::abs(a.y() - b.y()) < 0.01) upright.push_back(std::abs(a.z() - b.z()));
      });
      ASSERT_FALSE(upright.empty());
      EXPECT_NEAR(median(upright), thickness / rows, 0.1 * thickness) << thickness << ' ' << rows;
    }
  }
}

}  // namespace
}  // namespace hybrid_quad
