#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "hybrid_quad/spanning_parameterization/dislocations.h"
#include "hybrid_quad/spanning_parameterization/sign_gauge.h"
#include "hybrid_quad/spanning_parameterization/spanning_parameterization.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

struct Solved {
  PeriodicField field;
  SpanningParameterization param;
};

Solved solved(const WorkingSurface& surface, const FrameField& frames, SpanningOptions options = {}) {
  Solved s;
  s.field = solve_periodic_field(surface, frames, PeriodicFieldOptions{}, RunContext{});
  s.param = build_spanning_parameterization(surface, frames, s.field, options, RunContext{});
  const auto found = violations_of(s.param, surface, frames);
  EXPECT_TRUE(found.empty()) << found.front();
  return s;
}

/// The area of all regular faces in the grid's plane, in quads.
double grid_area(const SpanningParameterization& p) {
  double twice = 0;
  for (std::size_t f = 0; f < p.is_regular.size(); ++f) {
    const GridVector &x = p.halfedge_uv[3 * f], &y = p.halfedge_uv[3 * f + 1];
    if (p.is_regular[f]) twice += static_cast<double>(x[0] * y[1] - x[1] * y[0]);
  }
  return 0.5 * twice / (static_cast<double>(kGridUnit) * static_cast<double>(kGridUnit));
}

int regular_faces(const SpanningParameterization& p) {
  int n = 0;
  for (const char r : p.is_regular) n += r;
  return n;
}

TEST(SpanningParameterization, AlignedFlatGridIsItsOwnGrid) {
  const WorkingSurface surface = test::surface_of(test::flat_grid(20, 14, 5, 4), 1);
  const FrameField frames = test::constant_frames(surface, {1, 0, 0}, {0, 1, 0});
  const SpanningParameterization p = solved(surface, frames).param;
  EXPECT_EQ(p.dislocations_found, 0);
  EXPECT_EQ(regular_faces(p), surface.mesh.face_count());
  EXPECT_DOUBLE_EQ(grid_area(p), 20);
  for (int h = 0; h < surface.mesh.halfedge_count(); ++h) {
    const Vector2 measured = frames.grid_vector(surface.mesh, h);
    for (int c = 0; c < 2; ++c)
      EXPECT_NEAR(static_cast<double>(p.halfedge_uv[h][c]) / kGridUnit, measured[c], 1e-4);
  }
}

TEST(SpanningParameterization, RectangleOfFractionalSizeGetsWholeQuads) {
  const WorkingSurface surface = test::surface_of(test::flat_grid(24, 24, 5.3, 3.6), 1);
  const FrameField frames = test::constant_frames(surface, {1, 0, 0}, {0, 1, 0});
  const SpanningParameterization p = solved(surface, frames).param;
  EXPECT_EQ(p.dislocations_left, 0);
  EXPECT_EQ(regular_faces(p), surface.mesh.face_count());
  EXPECT_DOUBLE_EQ(grid_area(p), 20);
}

TEST(SpanningParameterization, ThinRectangleKeepsItsShortSides) {
  const WorkingSurface surface = test::surface_of(test::flat_grid(40, 2, 10, 0.3), 1);
  const FrameField frames = test::constant_frames(surface, {1, 0, 0}, {0, 1, 0});
  const SpanningParameterization p = solved(surface, frames).param;
  EXPECT_EQ(p.vanished_curves, 0);
  EXPECT_DOUBLE_EQ(grid_area(p), 10);
}

TEST(SpanningParameterization, TorusClosesAndCountsWholeQuads) {
  const WorkingSurface surface = test::surface_of(test::torus(48, 24), 0.3, 181);
  for (const auto& [around, along] : {std::pair{16.0, 6.0}, {15.3, 6.4}, {5.0, 3.0}}) {
    const FrameField frames = test::torus_frames(surface, around, along);
    const SpanningParameterization p = solved(surface, frames).param;
    EXPECT_EQ(p.dislocations_left, 0);
    EXPECT_EQ(p.folded_faces, 0);
    const double area = grid_area(p);
    EXPECT_NEAR(area, std::round(area), 1e-9);
    EXPECT_NEAR(area, around * along, 0.45 * around * along);
  }
}

TEST(SpanningParameterization, ChargesOfAClosedFlatBundleCancel) {
  // Orthonormal frames on a torus are not integrable: dislocations come, but where no turn is left their sum
  // is zero.
  const WorkingSurface surface = test::surface_of(test::torus(60, 40, 1, 0.6), 0.1, 181);
  FrameField frames = test::torus_frames(surface, 40, 24);
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    frames.du[f] *= 8 / frames.du[f].norm();
    frames.dv[f] *= 8 / frames.dv[f].norm();
  }
  SpanningOptions keep;
  keep.cancel_dislocations = false;
  const SpanningParameterization p = solved(surface, frames, keep).param;
  bool flat = true;
  for (const auto m : frames.matching) flat = flat && m == 0;
  ASSERT_TRUE(flat);
  int a = 0, b = 0;
  for (const auto& c : p.charge) {
    a += c[0];
    b += c[1];
  }
  EXPECT_GT(p.dislocations_found, 0);
  EXPECT_EQ(p.dislocations_left, p.dislocations_found);
  EXPECT_EQ(a, 0);
  EXPECT_EQ(b, 0);
  const SpanningParameterization q = solved(surface, frames).param;
  EXPECT_EQ(q.dislocations_found, p.dislocations_found);
  EXPECT_EQ(q.dislocations_left, 0);
}

TEST(SpanningParameterization, BoxIsWholeOnItsGrid) {
  const WorkingSurface surface = test::surface_of(test::box(10, {1, 2, 1}), 0.25);
  const FrameField frames = test::smooth_frames(surface, 0.25);
  const Solved s = solved(surface, frames);
  EXPECT_EQ(s.param.dislocations_left, 0);
  EXPECT_EQ(s.param.vanished_curves, 0);
  EXPECT_EQ(s.param.folded_feature_edges, 0);
  EXPECT_EQ(regular_faces(s.param), surface.mesh.face_count());
  EXPECT_DOUBLE_EQ(grid_area(s.param), 2 * (4 * 4 + 4 * 8 + 4 * 8));
}

TEST(SpanningParameterization, RowsThatEndOnSidesWithoutConesGoOverTheEdgesOfABox) {
  // Every side wants another length: what one has too many of, another has too few. A side has no cones, and a whole
  // dislocation cannot cross an edge.
  for (const double misfit : {0.08, 0.15}) {
    const WorkingSurface surface = test::surface_of(test::box(20, {1, 2, 1.5}), 0.12);
    FrameField frames = test::smooth_frames(surface, 0.12);
    for (int f = 0; f < surface.mesh.face_count(); ++f) {
      const Vector3 n = surface.mesh.normal(f);
      const double scale = 1 + misfit * (n[0] - 0.5 * n[1] + 1.5 * n[2]);
      frames.du[f] *= scale;
      frames.dv[f] *= scale;
    }
    const SpanningParameterization p = solved(surface, frames).param;
    EXPECT_GT(p.dislocations_found, 0);
    EXPECT_EQ(p.dislocations_left, 0);
    EXPECT_EQ(p.vanished_curves, 0);
    EXPECT_DOUBLE_EQ(grid_area(p), std::round(grid_area(p)));
  }
}

TEST(SignGauge, EvensOutWhatAShiftOfValuesExplains) {
  const WorkingSurface surface = test::surface_of(test::torus(30, 20), 0.3, 181);
  const TriangleMesh& mesh = surface.mesh;
  LiftedGrid grid;
  grid.value.assign(mesh.vertex_count(), Vector2(0.25, 0.5));
  grid.jump.assign(mesh.halfedge_count(), IntVector2{0, 0});
  grid.corner_turn.assign(mesh.halfedge_count(), 0);
  grid.corner_turn[5] = 1;  // gauges differ somewhere
  std::vector<Vector2> measured(mesh.halfedge_count());
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int inside = mesh.position(mesh.to(h))[2] > 0, outside = mesh.position(mesh.from(h))[2] > 0;
    grid.jump[h] = {3 * (inside - outside), 0};
    measured[h] = grid.across_half_edge(mesh, h);
  }
  ASSERT_TRUE(make_jumps_even(mesh, grid));
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    EXPECT_EQ((grid.jump[h][0] + grid.jump[h][1]) % 2, 0);
    EXPECT_EQ(grid.across_half_edge(mesh, h), measured[h]);
  }
}

TEST(SignGauge, RefusesALoopThatIsOdd) {
  const WorkingSurface surface = test::surface_of(test::torus(30, 20), 0.3, 181);
  const TriangleMesh& mesh = surface.mesh;
  LiftedGrid grid;
  grid.value.assign(mesh.vertex_count(), Vector2(0, 0));
  grid.jump.assign(mesh.halfedge_count(), IntVector2{0, 0});
  grid.corner_turn.assign(mesh.halfedge_count(), 0);
  // One row more around the tube: where the torus is cut by a half plane.
  const auto beyond = [&](int v) { return mesh.position(v)[1] > 0; };
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.position(mesh.from(h))[0] > 0 && beyond(mesh.from(h)) != beyond(mesh.to(h)))
      grid.jump[h] = {beyond(mesh.to(h)) ? 1 : -1, 0};
  EXPECT_FALSE(can_make_jumps_even(mesh, grid));
  EXPECT_FALSE(make_jumps_even(mesh, grid));
}

TEST(SpanningParameterization, ConesTakeDislocationsIn) {
  for (const double h : {0.31, 0.17, 0.11}) {
    const WorkingSurface surface = test::surface_of(test::icosphere(5), h, 181);
    const FrameField frames = test::smooth_frames(surface, h);
    const SpanningParameterization p = solved(surface, frames).param;
    EXPECT_EQ(p.dislocations_left, 0);
    EXPECT_LT(p.folded_faces, 0.01 * surface.mesh.face_count());
    for (int v = 0; v < surface.mesh.vertex_count(); ++v)
      EXPECT_EQ(p.is_grid_vertex[v] != 0, frames.cone_index[v] != 0);
  }
}

TEST(SpanningParameterization, CappedCylinderKeepsItsRims) {
  const WorkingSurface surface = test::surface_of(test::capped_cylinder(64, 32), 0.2);
  const FrameField frames = test::smooth_frames(surface, 0.2);
  const SpanningParameterization p = solved(surface, frames).param;
  EXPECT_EQ(p.vanished_curves, 0);
  EXPECT_EQ(p.folded_feature_edges, 0);
}

TEST(SpanningParameterization, CheckSeesEveryKindOfDamage) {
  const WorkingSurface surface = test::surface_of(test::box(6), 0.3);
  const FrameField frames = test::smooth_frames(surface, 0.3);
  const SpanningParameterization good = solved(surface, frames).param;
  const auto broken = [&](auto&& damage) {
    SpanningParameterization p = good;
    damage(p);
    return !violations_of(p, surface, frames).empty();
  };
  EXPECT_TRUE(broken([](auto& p) { ++p.halfedge_uv[5][0]; }));
  EXPECT_TRUE(broken([](auto& p) { ++p.corner_uv[10][1]; }));
  EXPECT_TRUE(broken([](auto& p) { p.charge[3][0] = 1; }));
  EXPECT_TRUE(broken([](auto& p) {
    for (int i = 9; i < 12; ++i) p.corner_uv[i][0] += kGridUnit;
  }));
  EXPECT_TRUE(broken([&](auto& p) {
    for (int v = 0; v < surface.mesh.vertex_count(); ++v)
      if (surface.features.is_corner[v]) p.is_grid_vertex[v] = 0;
  }));
}

TEST(SpanningParameterization, TakesNothingPiecesAndBadFrames) {
  const WorkingSurface nothing;
  EXPECT_TRUE(solved(nothing, FrameField{}).param.corner_uv.empty());
  std::vector<Vector3> points;
  std::vector<std::array<int, 3>> faces;
  for (const TriangleMesh& piece : {test::box(5), test::icosphere(2)}) {
    const int shift = static_cast<int>(points.size());
    for (const Vector3& p : piece.positions()) points.push_back(p + Vector3(3.0 * shift, 0, 0));
    for (const auto& t : piece.faces()) faces.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  points.push_back({9, 9, 9});  // no face
  const WorkingSurface surface = test::surface_of(TriangleMesh(points, faces), 0.3);
  FrameField frames = test::smooth_frames(surface, 0.3);
  EXPECT_GT(regular_faces(solved(surface, frames).param), surface.mesh.face_count() / 2);
  frames.du[7].setConstant(std::nan(""));
  frames.du[11].setZero();
  frames.dv[30] *= 1e6;
  solved(surface, frames);
}

TEST(SpanningParameterization, ModelsKeepFewDefects) {
  const std::string folder = test::models_folder();
  if (folder.empty()) GTEST_SKIP() << "no models";
  const std::string path = folder + "/dir_fertility_input.obj";
  if (!std::ifstream(path)) GTEST_SKIP() << "no such model";
  const PolygonSoup soup = test::read_obj(path);
  std::vector<std::array<int, 3>> faces;
  for (std::size_t i = 0; i + 2 < soup.face_vertices.size(); i += 3)
    faces.push_back({soup.face_vertices[i], soup.face_vertices[i + 1], soup.face_vertices[i + 2]});
  TriangleMesh mesh(soup.positions, faces);
  const double h = std::sqrt(mesh.total_area() / 2000);
  const WorkingSurface surface = test::surface_of(std::move(mesh), h, 181);
  const SpanningParameterization p = solved(surface, test::smooth_frames(surface, h)).param;
  EXPECT_EQ(p.dislocations_left, 0);
  EXPECT_LT(p.folded_faces, 0.003 * surface.mesh.face_count());
}

}  // namespace
}  // namespace hybrid_quad
