#include <gtest/gtest.h>

#include "hybrid_quad/mesh/straight_quads.h"
#include "support/quad_complexes.h"

namespace hybrid_quad {
namespace {

/// A grid whose quad at one border side has three sides on a curve: the strip of corners is marked as one curve.
QuadComplex grid_with_ear() {
  QuadComplex c = test::quad_grid(3, 3);
  // Quad 0's sides except the one shared with quad 3 or 1, whichever is the fourth.
  int free = -1;
  for (int d = 0; d < 4; ++d)
    if (c.opposite[d] >= 0) free = d;
  for (int d = 0; d < 4; ++d) {
    if (d == free) continue;
    c.curve[d] = 0;
    if (c.opposite[d] >= 0) c.curve[c.opposite[d]] = 0;
    for (const int v : {c.from(d), c.to(d)}) {
      c.kind[v] = VertexKind::kCurve;
      c.anchor[v] = 0;
    }
  }
  return c;
}

TEST(StraightQuads, OpensAQuadWithThreeSidesOnACurve) {
  QuadComplex c = grid_with_ear();
  ASSERT_TRUE(violations_of(c).empty()) << violations_of(c).front();
  const int before = c.quad_count(), chi = euler_characteristic(c);
  EXPECT_EQ(open_straight_quads(c), 1);
  EXPECT_EQ(c.quad_count(), before + 2);
  EXPECT_EQ(euler_characteristic(c), chi);
  ASSERT_TRUE(violations_of(c).empty()) << violations_of(c).front();
  EXPECT_TRUE(violations_of(to_quad_mesh(c)).empty());
  EXPECT_EQ(open_straight_quads(c), 0) << "no quad has three sides on the curve any more";
}

TEST(StraightQuads, LeavesCornersAlone) {
  QuadComplex c = grid_with_ear();
  for (VertexKind& k : c.kind)
    if (k == VertexKind::kCurve) k = VertexKind::kCorner;
  const int before = c.quad_count();
  EXPECT_EQ(open_straight_quads(c), 0);
  EXPECT_EQ(c.quad_count(), before);
}

}  // namespace
}  // namespace hybrid_quad
