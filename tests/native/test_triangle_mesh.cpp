#include <gtest/gtest.h>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {
namespace {

TriangleMesh tetrahedron() {
  return TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

TEST(TriangleMesh, PairsEveryEdgeOfAClosedSurface) {
  const TriangleMesh m = tetrahedron();
  for (int h = 0; h < m.halfedge_count(); ++h) {
    ASSERT_GE(m.opposite(h), 0);
    EXPECT_EQ(m.opposite(m.opposite(h)), h);
    EXPECT_EQ(m.from(m.opposite(h)), m.to(h));
  }
  EXPECT_EQ(m.euler_characteristic(), 2);
}

TEST(TriangleMesh, BoundaryFanStartsAtItsFirstHalfedge) {
  const TriangleMesh m({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  for (int v = 0; v < 4; ++v) {
    EXPECT_TRUE(m.is_boundary_vertex(v));
    EXPECT_TRUE(m.is_boundary(m.outgoing(v)));
  }
  int fan = 0;
  for (int h = m.outgoing(0); h >= 0; h = m.rotate_ccw(h)) ++fan;
  EXPECT_EQ(fan, 2);
  EXPECT_EQ(m.euler_characteristic(), 1);
}

TEST(TriangleMesh, KeepsItsHalfedgesWhereItIsMoved) {
  const TriangleMesh m = tetrahedron();
  std::vector<Vector3> twice = m.positions();
  for (Vector3& p : twice) p *= 2;
  const TriangleMesh moved = TriangleMesh(m).with_positions(twice);
  EXPECT_EQ(moved.positions(), twice);
  EXPECT_EQ(moved.faces(), m.faces());
  EXPECT_EQ(moved.opposites(), m.opposites());
  for (int v = 0; v < m.vertex_count(); ++v) EXPECT_EQ(moved.outgoing(v), m.outgoing(v));
  EXPECT_NEAR(moved.total_area(), 4 * m.total_area(), 1e-12);
}

TEST(TriangleMesh, RefusesWhatIsNoManifold) {
  const std::vector<Vector3> p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  EXPECT_THROW(TriangleMesh(p, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), InternalError);
  EXPECT_THROW(TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}), InternalError);
}

}  // namespace
}  // namespace hybrid_quad
