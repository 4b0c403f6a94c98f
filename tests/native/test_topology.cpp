// Pieces, Euler characteristic and border loops: what one of them alone cannot tell apart.
#include <gtest/gtest.h>

#include <ostream>

#include "hybrid_quad/mesh/topology.h"
#include "support/meshes.h"
#include "support/quad_complexes.h"

namespace hybrid_quad {

// Beside the type, where GoogleTest looks for it.
std::ostream& operator<<(std::ostream& out, const Topology& t) {
  return out << t.pieces << " pieces, Euler characteristic " << t.euler_characteristic << ", " << t.border_loops << " loops";
}

namespace {

/// Both, side by side.
TriangleMesh beside(const TriangleMesh& a, const TriangleMesh& b) {
  std::vector<Vector3> positions = a.positions();
  std::vector<std::array<int, 3>> faces = a.faces();
  for (const Vector3& p : b.positions()) positions.push_back(p + Vector3(10, 0, 0));
  for (std::array<int, 3> face : b.faces()) {
    for (int& v : face) v += a.vertex_count();
    faces.push_back(face);
  }
  return {positions, faces};
}

TEST(Topology, OfTriangles) {
  EXPECT_EQ(topology_of(test::icosphere(1)), (Topology{1, 2, 0}));
  EXPECT_EQ(topology_of(test::torus(8, 6)), (Topology{1, 0, 0}));
  EXPECT_EQ(topology_of(test::flat_grid(3, 2)), (Topology{1, 1, 1}));
  EXPECT_EQ(topology_of(test::open_cylinder(8, 3)), (Topology{1, 0, 2}));
}

TEST(Topology, TellsApartWhatTheEulerCharacteristicDoesNot) {
  EXPECT_NE(topology_of(test::torus(8, 6)), topology_of(test::open_cylinder(8, 3)));
  EXPECT_NE(topology_of(beside(test::torus(8, 6), test::flat_grid(3, 2))), topology_of(test::flat_grid(3, 2)));
  const TriangleMesh two = beside(test::icosphere(1), test::open_cylinder(8, 3));
  EXPECT_EQ(topology_of(two), (Topology{2, 2, 2}));
  EXPECT_NE(topology_of(two), topology_of(test::icosphere(1)));
}

TEST(Topology, OfEveryPiece) {
  EXPECT_EQ(euler_characteristics_of_pieces(beside(test::icosphere(1), test::open_cylinder(8, 3))), (std::vector<int>{0, 2}));
  EXPECT_EQ(euler_characteristics_of_pieces(test::icosphere(1)), (std::vector<int>{2}));
  EXPECT_EQ(euler_characteristics_of_pieces(test::even_quads(3, 0)), (std::vector<int>{1}));
  EXPECT_EQ(euler_characteristics_of_pieces(TriangleMesh()), std::vector<int>());
}

TEST(Topology, OfQuads) {
  EXPECT_EQ(topology_of(test::quad_torus(5, 4)), (Topology{1, 0, 0}));
  EXPECT_EQ(topology_of(test::quad_tube(5, 3)), (Topology{1, 0, 2}));
  EXPECT_EQ(topology_of(test::even_quads(3, 0)), (Topology{1, 1, 1}));
  EXPECT_EQ(border_loops_of(test::open_cylinder(8, 3)), 2);
  EXPECT_EQ(border_loops_of(test::icosphere(1)), 0);
}

}  // namespace
}  // namespace hybrid_quad
