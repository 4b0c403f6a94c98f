#include <gtest/gtest.h>

#include "hybrid_quad/spanning_parameterization/closed_rows.h"
#include "hybrid_quad/spanning_parameterization/sign_gauge.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

/// A surface without features whose grid has no jumps.
struct Plain {
  Plain(TriangleMesh mesh, double h) : surface(test::surface_of(std::move(mesh), h, 181)) {
    const TriangleMesh& m = surface.mesh;
    grid.value.assign(m.vertex_count(), Vector2(0, 0));
    grid.jump.assign(m.halfedge_count(), IntVector2{0, 0});
    grid.constraint.assign(m.vertex_count(), GridConstraint::kFree);
    grid.corner_turn.assign(m.halfedge_count(), 0);
    grid.holonomy.assign(m.vertex_count(), 0);
  }
  WorkingSurface surface;
  LiftedGrid grid;
};

TEST(GeneratingLoops, AreTwoPerHandle) {
  const auto bits = [](const TriangleMesh& mesh) {
    const GeneratingLoops loops(mesh);
    GeneratingLoops::Set all = 0;
    for (int h = 0; h < mesh.halfedge_count(); ++h) {
      all |= loops.through(h);
      EXPECT_EQ(loops.through(h), loops.through(mesh.opposite(h)));
    }
    EXPECT_TRUE(loops.fit());
    return all;
  };
  EXPECT_EQ(bits(test::icosphere(3)), 0u);
  EXPECT_EQ(bits(test::torus(20, 12)), 3u);
}

TEST(GeneratingLoops, AreClosed) {
  const TriangleMesh mesh = test::torus(20, 12);
  const GeneratingLoops loops(mesh);
  std::vector<GeneratingLoops::Set> at(mesh.vertex_count(), 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h) at[mesh.from(h)] ^= loops.through(h);
  for (const GeneratingLoops::Set set : at) EXPECT_EQ(set, 0u);
}

TEST(ClosedRows, ChangeTheSignAroundTheLoopsTheyCrossAndNothingElse) {
  Plain torus(test::torus(40, 24), 0.3);
  const TriangleMesh& mesh = torus.surface.mesh;
  const FrameField frames = test::torus_frames(torus.surface, 16, 8);
  const GridMeasure measure = measure_edges(torus.surface, frames);
  MovableGrid movable(torus.surface, frames, measure, 1, torus.grid);
  const GeneratingLoops loops(mesh);
  EXPECT_EQ(loops.odd(torus.grid), 0u);
  for (const GeneratingLoops::Set wanted : {1, 2, 3}) {
    std::size_t states = 1000000;
    const auto row = shortest_closed_row(movable, loops, wanted, {7}, states, RunContext{});
    ASSERT_TRUE(row);
    EXPECT_LT(states, 1000000u);
    std::vector<IntVector2> carried;
    IntVector2 b = row->burgers;
    for (const int h : row->crossed) {
      EXPECT_EQ(h / 3, carried.empty() ? 7 : mesh.opposite(row->crossed[carried.size() - 1]) / 3);
      movable.cross(h, b);
      carried.push_back(b);
      b = turned(b, frames.matching[h]);
    }
    EXPECT_EQ(b, row->burgers);
    for (int f = 0; f < mesh.face_count(); ++f) EXPECT_EQ(torus.grid.burgers(f), (IntVector2{0, 0}));
    EXPECT_EQ(loops.odd(torus.grid), wanted);
    EXPECT_FALSE(can_make_jumps_even(mesh, torus.grid));
    for (std::size_t i = 0; i < carried.size(); ++i) movable.cross(row->crossed[i], minus(carried[i]));
    EXPECT_EQ(loops.odd(torus.grid), 0u);
  }
}

TEST(ClosedRows, NoneWhereThereIsNothingToGoAround) {
  Plain ball(test::icosphere(4), 0.3);
  const FrameField frames = test::smooth_frames(ball.surface, 0.3);
  const GridMeasure measure = measure_edges(ball.surface, frames);
  MovableGrid movable(ball.surface, frames, measure, 1, ball.grid);
  std::size_t states = 100000;
  EXPECT_FALSE(shortest_closed_row(movable, GeneratingLoops(ball.surface.mesh), 0, {0}, states, RunContext{}));
  EXPECT_FALSE(shortest_closed_row(movable, GeneratingLoops(ball.surface.mesh), 1, {0}, states, RunContext{}));
}

}  // namespace
}  // namespace hybrid_quad
