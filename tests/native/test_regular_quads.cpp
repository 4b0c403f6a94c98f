#include <gtest/gtest.h>

#include <random>

#include "hybrid_quad/regular_quads/curve_coordinates.h"
#include "hybrid_quad/regular_quads/regular_quads.h"
#include "hybrid_quad/singular_patches/singular_patches.h"
#include "hybrid_quad/assemble/assemble.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

using test::flat_grid;
using test::surface_of;

struct Scene {
  WorkingSurface surface;
  FrameField frames;
  SpanningParameterization param;
};

/// A flat rectangle of columns x rows quads, triangulated without regard to the grid, in exact coordinates.
Scene rectangle(int n, int m, int columns, int rows) {
  Scene s;
  s.surface = surface_of(flat_grid(n, m, columns, rows), 1.0);
  s.frames = test::constant_frames(s.surface, Vector3(1, 0, 0), Vector3(0, 1, 0));
  // Frames may have been turned while they were combed: measure in what each face has now.
  const TriangleMesh& mesh = s.surface.mesh;
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const auto grid_of = [&](int v) {
      GridVector out;
      for (int axis = 0; axis < 2; ++axis) {
        const Vector3& row = axis ? s.frames.dv[h / 3] : s.frames.du[h / 3];
        out[axis] = std::llround(row.dot(mesh.position(v)) * kGridUnit);
      }
      return out;
    };
    const GridVector a = grid_of(mesh.from(h)), b = grid_of(mesh.to(h));
    s.param.corner_uv.push_back(a);
    s.param.halfedge_uv.push_back({b[0] - a[0], b[1] - a[1]});
  }
  s.param.charge.assign(mesh.face_count(), {0, 0});
  s.param.is_regular.assign(mesh.face_count(), 1);
  s.param.is_grid_vertex.assign(mesh.vertex_count(), 0);
  return s;
}

TEST(RegularQuads, CoverARectangleWhateverItsTriangles) {
  for (const auto& [n, m] : {std::pair{7, 5}, {3, 2}, {12, 9}, {24, 18}, {1, 1}}) {
    const Scene s = rectangle(n, m, 12, 9);
    const RegularQuads q = extract_regular_quads(s.surface, s.frames, s.param, RunContext{});
    EXPECT_TRUE(violations_of(q).empty());
    EXPECT_EQ(q.side.size(), 108u) << n << " x " << m;
    for (const int cell : q.piece_cell) EXPECT_GE(cell, 0);
  }
}

TEST(RegularQuads, CurvesFollowTheirIsolinesWhereFramesAreSlanted) {
  Scene s = rectangle(7, 5, 12, 9);
  ASSERT_EQ(build_curve_coordinates(s.surface, s.frames, s.param).altered_edges, 0);
  for (int h = 0; h < s.surface.mesh.halfedge_count(); ++h) {
    if (!s.surface.mesh.is_boundary(h)) continue;
    Vector3 &du = s.frames.du[h / 3], &dv = s.frames.dv[h / 3];
    if (s.param.halfedge_uv[h][1] == 0) dv += 2 * du;
    else du += 2 * dv;
    break;
  }
  EXPECT_EQ(build_curve_coordinates(s.surface, s.frames, s.param).altered_edges, 0);
  EXPECT_EQ(extract_regular_quads(s.surface, s.frames, s.param, RunContext{}).side.size(), 108u);
}

TEST(RegularQuads, OverlayKeepsTheArea) {
  const Scene s = rectangle(7, 5, 12, 9);
  const RegularQuads q = extract_regular_quads(s.surface, s.frames, s.param, RunContext{});
  double area = 0;
  for (int p = 0; p < q.overlay.piece_count(); ++p) {
    const auto point = [&](int k) { return q.overlay.vertices[q.overlay.origin[k]].position; };
    const int b = q.overlay.piece_begin[p];
    for (int k = b + 1; k + 1 < q.overlay.piece_begin[p + 1]; ++k) area += (point(k) - point(b)).cross(point(k + 1) - point(b))[2] / 2;
  }
  EXPECT_NEAR(area, 108, 1e-9);
}

TEST(RegularQuads, AnyNumberOfThreadsGivesTheSameBits) {
  Scene s = rectangle(60, 50, 80, 70);
  std::mt19937 random(1);
  for (char& r : s.param.is_regular) r = random() % 100 < 95;
  const auto extracted = [&](int threads) {
    RunContext context;
    context.threads = threads;
    return extract_regular_quads(s.surface, s.frames, s.param, context);
  };
  const RegularQuads one = extracted(1);
  for (const int threads : {2, 3}) {
    const RegularQuads many = extracted(threads);
    EXPECT_EQ(many.side, one.side);
    EXPECT_EQ(many.piece_cell, one.piece_cell);
    const GridOverlay &a = many.overlay, &b = one.overlay;
    EXPECT_EQ(a.piece_begin, b.piece_begin);
    EXPECT_EQ(a.piece_face, b.piece_face);
    EXPECT_EQ(a.piece_regular, b.piece_regular);
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.opposite, b.opposite);
    EXPECT_EQ(a.piece_of, b.piece_of);
    EXPECT_EQ(a.on_isoline, b.on_isoline);
    EXPECT_EQ(a.curve, b.curve);
    EXPECT_EQ(a.uv, b.uv);
    EXPECT_EQ(a.surface_halfedge, b.surface_halfedge);
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    for (std::size_t v = 0; v < a.vertices.size(); ++v) {
      EXPECT_EQ(a.vertices[v].position, b.vertices[v].position);
      EXPECT_EQ(a.vertices[v].surface_vertex, b.vertices[v].surface_vertex);
      EXPECT_EQ(a.vertices[v].grid_sign, b.vertices[v].grid_sign);
    }
  }
}

/// Whatever faces lose their parameterization, patches fill the hole and the whole stays a disk with the same border.
TEST(RegularQuads, PatchesFillWhatIsNotRegular) {
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    Scene s = rectangle(15, 12, 10, 8);
    for (char& r : s.param.is_regular) r = random() % 100 < 90 - 4u * static_cast<unsigned>(round);
    RegularQuads q = extract_regular_quads(s.surface, s.frames, s.param, RunContext{});
    EXPECT_TRUE(violations_of(q).empty());
    EXPECT_LT(q.side.size(), 80u);
    const SingularPatches patches = fill_singular_patches(s.surface, s.frames, s.param, q, PatchOptions{}, RunContext{});
    const QuadComplex complex = assemble_quads(s.surface, q, patches);
    EXPECT_TRUE(violations_of(complex).empty());
    EXPECT_EQ(euler_characteristic(complex), 1);
    int border = 0;
    for (const int o : complex.opposite) border += o < 0;
    EXPECT_EQ(border, 36);
    // The function is the same with or without a parameterization, so the quads are too.
    EXPECT_EQ(complex.quad_count(), 80);
    for (const FilledPatch& p : patches.patches) EXPECT_FALSE(p.combinatorial) << p.rejected.front();
  }
}

/// Where faces that are not regular lie between two parts of a curve, each part keeps the places that the chart beside it gives it.
TEST(RegularQuads, CurvesFollowChartsThatDoNotContinueEachOther) {
  for (const std::int64_t shift : {kGridUnit / 3, -kGridUnit / 5, kGridUnit}) {
    Scene s = rectangle(24, 18, 12, 9);
    const TriangleMesh& mesh = s.surface.mesh;
    for (int f = 0; f < mesh.face_count(); ++f) {
      const auto& v = mesh.face(f);
      const double x = (mesh.position(v[0])[0] + mesh.position(v[1])[0] + mesh.position(v[2])[0]) / 3;
      s.param.is_regular[f] = x < 3 || (x > 4 && x < 8) || x > 9;
      if (x > 4 && x < 8)
        for (int i = 0; i < 3; ++i)
          for (int axis = 0; axis < 2; ++axis) {
            const Vector3& row = axis ? s.frames.dv[f] : s.frames.du[f];
            s.param.corner_uv[3 * f + i][axis] += std::llround(row[0] * static_cast<double>(shift));
          }
    }
    RegularQuads q = extract_regular_quads(s.surface, s.frames, s.param, RunContext{});
    EXPECT_TRUE(violations_of(q).empty());
    EXPECT_GT(q.side.size(), 54u + 18u) << "of 54 beside the band and 27 in it that are whole";
    const SingularPatches patches = fill_singular_patches(s.surface, s.frames, s.param, q, PatchOptions{}, RunContext{});
    const QuadComplex complex = assemble_quads(s.surface, q, patches);
    EXPECT_TRUE(violations_of(complex).empty());
    EXPECT_EQ(euler_characteristic(complex), 1);
  }
}

}  // namespace
}  // namespace hybrid_quad
