#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "hybrid_quad/spanning_parameterization/closed_rows.h"
#include "hybrid_quad/spanning_parameterization/row_cycles.h"
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
    const std::vector<ClosedRow> rows = closed_rows_that_flip(movable, loops, wanted, 7, RunContext{});
    ASSERT_FALSE(rows.empty());
    std::vector<std::pair<int, IntVector2>> carried;
    for (const ClosedRow& row : rows) {
      IntVector2 b = row.burgers;
      for (std::size_t i = 0; i < row.crossed.size(); ++i) {
        const int h = row.crossed[i], next = row.crossed[(i + 1) % row.crossed.size()];
        EXPECT_EQ(mesh.opposite(h) / 3, next / 3);
        movable.cross(h, b);
        carried.emplace_back(h, b);
        b = turned(b, frames.matching[h]);
      }
      EXPECT_EQ(b, row.burgers);
    }
    for (int f = 0; f < mesh.face_count(); ++f) EXPECT_EQ(torus.grid.burgers(f), (IntVector2{0, 0}));
    EXPECT_EQ(loops.odd(torus.grid), wanted);
    EXPECT_FALSE(can_make_jumps_even(mesh, torus.grid));
    for (const auto& [h, b] : carried) movable.cross(h, minus(b));
    EXPECT_EQ(loops.odd(torus.grid), 0u);
  }
}

TEST(ClosedRows, NoneWhereThereIsNothingToGoAround) {
  Plain ball(test::icosphere(4), 0.3);
  const FrameField frames = test::smooth_frames(ball.surface, 0.3);
  const GridMeasure measure = measure_edges(ball.surface, frames);
  MovableGrid movable(ball.surface, frames, measure, 1, ball.grid);
  const GeneratingLoops loops(ball.surface.mesh);
  EXPECT_TRUE(closed_rows_that_flip(movable, loops, 0, 0, RunContext{}).empty());
  EXPECT_TRUE(closed_rows_that_flip(movable, loops, 1, 0, RunContext{}).empty());
}

TEST(LoopSums, AddUp) {
  LoopSums sums;
  EXPECT_TRUE(sums.add(0b011));
  EXPECT_TRUE(sums.add(0b110));
  EXPECT_FALSE(sums.add(0b101));  // both together
  EXPECT_FALSE(sums.add(0));
  EXPECT_TRUE(sums.add(0b111));
  EXPECT_EQ(sums.rank(), 3u);
  const GeneratingLoops::Set added[] = {0b011, 0b110, 0b111};
  for (GeneratingLoops::Set wanted = 0; wanted < 8; ++wanted) {
    const auto of = sums.sum_for(wanted);
    ASSERT_TRUE(of);
    GeneratingLoops::Set sum = 0;
    for (int k = 0; k < 3; ++k)
      if (*of >> k & 1) sum ^= added[k];
    EXPECT_EQ(sum, wanted);
  }
  EXPECT_FALSE(sums.sum_for(0b1000));
}

RowRoute route(int from, int to) {
  RowRoute route;
  route.from = from;
  route.to = to;
  route.end = to < 0 ? RowRoute::End::kBoundary : RowRoute::End::kFace;
  return route;
}

TEST(RowCycles, ReachEverySiteAnEvenNumberOfTimes) {
  // Two there and back, a triangle, two to the boundary, and one that leads nowhere.
  const std::vector<RowRoute> routes = {route(1, 2), route(2, 3), route(3, 1), route(1, 2),  route(2, 1),
                                        route(4, 5), route(5, -1), route(4, -1), route(3, 6), route(7, 7)};
  const std::vector<RowCycle> cycles = cycles_of(routes);
  std::vector<int> uses(routes.size(), 0);
  for (const RowCycle& cycle : cycles) {
    std::map<int, int> visits;
    for (const int i : cycle) {
      ++uses[i];
      ++visits[routes[i].from];
      ++visits[routes[i].to];
    }
    for (const auto& [site, count] : visits) EXPECT_EQ(count % 2, 0) << site;
  }
  EXPECT_EQ(cycles.size(), 4u);
  EXPECT_EQ(uses, (std::vector<int>{1, 1, 1, 1, 1, 1, 1, 1, 0, 1}));
}

TEST(RowCycles, AreLeftOutSoThatTheOthersFlipNothing) {
  const std::vector<RowCycle> cycles = {{0, 1, 2}, {3, 4}, {5, 6, 7, 8}, {9, 10}};
  const std::vector<GeneratingLoops::Set> flips = {0b01, 0b01, 0b11, 0};
  const std::vector<int> left_out = cycles_to_leave_out(cycles, flips);
  GeneratingLoops::Set kept = 0;
  for (std::size_t k = 0; k < cycles.size(); ++k)
    if (std::find(left_out.begin(), left_out.end(), static_cast<int>(k)) == left_out.end()) kept ^= flips[k];
  EXPECT_EQ(kept, 0u);
  EXPECT_LE(left_out.size(), 2u);
  EXPECT_TRUE(cycles_to_leave_out(cycles, {0b10, 0b10, 0, 0}).empty());
}

}  // namespace
}  // namespace hybrid_quad
