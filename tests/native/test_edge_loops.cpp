#include <gtest/gtest.h>

#include "hybrid_quad/quality/edge_loops.h"
#include "support/quad_complexes.h"

namespace hybrid_quad {
namespace {

using test::quad_box;
using test::quad_grid;
using test::quad_torus;
using test::quad_tube;

int edge_count(const QuadComplex& complex) {
  int count = 0;
  for (std::size_t d = 0; d < complex.opposite.size(); ++d) count += complex.opposite[d] < static_cast<int>(d);
  return count;
}

TEST(EdgeLoops, EveryEdgeIsInOneChain) {
  for (const QuadComplex& complex : {quad_box(2, 3, 4), quad_grid(5, 3), quad_tube(6, 4), quad_torus(8, 5, 2), quad_torus(1, 1)}) {
    const EdgeLoops loops = trace_edge_loops(complex);
    int length = 0;
    for (const EdgeLoops::Chain& chain : loops.chains) length += chain.length;
    EXPECT_EQ(length, edge_count(complex));
    for (std::size_t d = 0; d < complex.opposite.size(); ++d)
      if (complex.opposite[d] >= 0) {
        EXPECT_EQ(loops.of_dart[d], loops.of_dart[complex.opposite[d]]);
      }
  }
}

TEST(EdgeLoops, GridLinesEndAtTheBoundary) {
  QuadComplex grid = quad_grid(5, 3);
  const EdgeLoopSummary open = summary_of(trace_edge_loops(grid));
  EXPECT_EQ(open.open, 4 + 6);
  EXPECT_EQ(open.closed, 0);
  EXPECT_EQ(open.longest, 5);
  EXPECT_EQ(open.spirals, 0);
  EXPECT_EQ(open.self_crossing, 0);
}

TEST(EdgeLoops, BoxChainsEndAtItsEightPoles) {
  const EdgeLoopSummary box = summary_of(trace_edge_loops(quad_box(4, 4, 4)));
  EXPECT_EQ(box.open, 12) << "the edges of the box";
  EXPECT_EQ(box.closed, 9) << "three around each axis";
  EXPECT_EQ(box.longest, 16);
  EXPECT_EQ(box.spirals, 0);
}

TEST(EdgeLoops, CornersEndChains) {
  QuadComplex torus = quad_torus(8, 6);
  EXPECT_EQ(summary_of(trace_edge_loops(torus)).open, 0);
  torus.kind[torus.vertex[0]] = VertexKind::kCorner;
  const EdgeLoopSummary cut = summary_of(trace_edge_loops(torus));
  EXPECT_EQ(cut.open, 2);
  EXPECT_EQ(cut.closed, 8 + 6 - 2);
}

TEST(EdgeLoops, ShiftedTorusHasASpiralInsteadOfClosedLoops) {
  constexpr int kAround = 12, kAlong = 30;
  const EdgeLoopSummary straight = summary_of(trace_edge_loops(quad_torus(kAround, kAlong)));
  EXPECT_EQ(straight.closed, kAround + kAlong);
  EXPECT_EQ(straight.spirals, 0);
  EXPECT_EQ(straight.longest, kAlong);
  for (const int shift : {1, kAround - 1}) {
    const EdgeLoopSummary shifted = summary_of(trace_edge_loops(quad_torus(kAround, kAlong, shift)));
    EXPECT_EQ(shifted.spirals, 1);
    EXPECT_EQ(shifted.longest_spiral, kAround * kAlong) << "all loops of one direction are one";
    EXPECT_EQ(shifted.closed, kAlong + 1);
    EXPECT_EQ(shifted.self_crossing, 0);
  }
  EXPECT_EQ(summary_of(trace_edge_loops(quad_torus(kAround, kAlong, 2))).spirals, 2) << "a screw of two threads";
}

TEST(EdgeLoops, TubeWithoutAShiftHasNoSpiralHoweverThin) {
  for (int n = 1; n <= 4; ++n) EXPECT_EQ(summary_of(trace_edge_loops(quad_tube(n, 9))).spirals, 0);
}

TEST(EdgeLoops, ChainsAroundAConeOfAQuarterCrossThemselves) {
  constexpr int kSize = 5;
  const EdgeLoopSummary cone = summary_of(trace_edge_loops(test::quad_cone(kSize)));
  EXPECT_EQ(cone.self_crossing, kSize - 1) << "all but the seam and the border";
  EXPECT_EQ(cone.spirals, 0);
}

}  // namespace
}  // namespace hybrid_quad
