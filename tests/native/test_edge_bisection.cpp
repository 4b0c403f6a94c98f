#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <set>
#include <vector>

#include "hybrid_quad/mesh/edge_bisection.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

double longest_edge(const TriangleMesh& mesh) {
  double longest = 0;
  for (int h = 0; h < mesh.halfedge_count(); ++h) longest = std::max(longest, mesh.edge_length(h));
  return longest;
}

TEST(EdgeBisection, BoundsEdgesAndKeepsTheSurface) {
  for (const TriangleMesh& mesh : {test::icosphere(1), test::box(1, Vector3(5, 1, 0.1)), test::flat_grid(2, 3, 4, 1), test::open_cylinder(7, 1, 1, 9)}) {
    const BisectedMesh fine = bisect_long_edges(mesh, 0.3, {});
    for (int h = 0; h < fine.mesh.halfedge_count(); ++h)
      if (fine.mesh.opposite(h) >= 0) {
        EXPECT_EQ(fine.mesh.opposite(fine.mesh.opposite(h)), h);
        EXPECT_EQ(fine.mesh.from(h), fine.mesh.to(fine.mesh.opposite(h)));
      }
    EXPECT_LE(longest_edge(fine.mesh), 0.3);
    EXPECT_NEAR(fine.mesh.total_area(), mesh.total_area(), 1e-12 * mesh.total_area());
    EXPECT_EQ(fine.mesh.euler_characteristic(), mesh.euler_characteristic());
    ASSERT_GE(fine.mesh.vertex_count(), mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(fine.mesh.position(v), mesh.position(v));
  }
}

TEST(EdgeBisection, KnowsWhichFaceEachIsAPartOf) {
  const TriangleMesh mesh = test::icosphere(1);
  const BisectedMesh fine = bisect_long_edges(mesh, 0.1, {});
  ASSERT_EQ(fine.face_source.size(), static_cast<std::size_t>(fine.mesh.face_count()));
  std::vector<double> area(mesh.face_count(), 0);
  for (int f = 0; f < fine.mesh.face_count(); ++f) {
    area[fine.face_source[f]] += fine.mesh.area(f);
    EXPECT_NEAR(fine.mesh.normal(f).dot(mesh.normal(fine.face_source[f])), 1, 1e-12);
  }
  for (int f = 0; f < mesh.face_count(); ++f) EXPECT_NEAR(area[f], mesh.area(f), 1e-12);
}

TEST(EdgeBisection, StopsWithTheLongestHalved) {
  const TriangleMesh hair = test::open_cylinder(3, 1, 1e-4, 100);
  constexpr int kMost = 500;
  const BisectedMesh fine = bisect_long_edges(hair, 0.05, {}, {}, kMost);
  EXPECT_EQ(fine.mesh.vertex_count(), hair.vertex_count() + kMost);
  EXPECT_LT(longest_edge(fine.mesh), 100.0 / 15);
  EXPECT_EQ(fine.mesh.euler_characteristic(), hair.euler_characteristic());
}

TEST(EdgeBisection, LeavesShortEdgesAlone) {
  const TriangleMesh mesh = test::icosphere(3);
  const EdgeSet marked{{mesh.from(0), mesh.to(0)}}, chain{{mesh.from(4), mesh.to(4)}};
  const BisectedMesh same = bisect_long_edges(mesh, longest_edge(mesh), marked, {chain});
  EXPECT_EQ(same.mesh.positions(), mesh.positions());
  EXPECT_EQ(same.mesh.faces(), mesh.faces());
  EXPECT_EQ(same.mesh.opposites(), mesh.opposites());
  for (int f = 0; f < mesh.face_count(); ++f) EXPECT_EQ(same.face_source[f], f);
  ASSERT_EQ(same.marked_edges.size(), 2u);
  EXPECT_EQ(std::multiset<int>(same.source.begin(), same.source.end()), (std::multiset<int>{-1, 0}));
  ASSERT_EQ(same.chains.size(), 1u);
  ASSERT_EQ(same.chains[0].size(), 1u);
  const auto ends = [](const std::array<int, 2>& e) { return std::set<int>{e[0], e[1]}; };
  EXPECT_EQ(ends(same.chains[0][0]), ends(chain[0]));
}

TEST(EdgeBisection, HandsMarksOnToTheParts) {
  const TriangleMesh mesh = test::box(1, Vector3(2, 2, 2));
  const int h = 0;
  const BisectedMesh fine = bisect_long_edges(mesh, 0.3, {{mesh.from(h), mesh.to(h)}});
  double length = 0;
  std::multiset<int> ends;
  for (const auto& e : fine.marked_edges) {
    length += (fine.mesh.position(e[0]) - fine.mesh.position(e[1])).norm();
    ends.insert({e[0], e[1]});
  }
  EXPECT_NEAR(length, mesh.edge_length(h), 1e-12);
  EXPECT_EQ(ends.count(mesh.from(h)), 1u);
  EXPECT_EQ(ends.count(mesh.to(h)), 1u);
  for (const int v : ends)
    if (v != mesh.from(h) && v != mesh.to(h)) {
      EXPECT_EQ(ends.count(v), 2u);
    }
}

/// Whether some edges have both ends in common.
bool has_edges_with_common_ends(const TriangleMesh& mesh) {
  std::set<std::array<int, 2>> ends;
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.opposite(h) < h && !ends.insert({std::min(mesh.from(h), mesh.to(h)), std::max(mesh.from(h), mesh.to(h))}).second)
      return true;
  return false;
}

TEST(EdgeBisection, NoTwoEdgesKeepBothEndsInCommon) {
  // Two triangles on the same three vertices, joined along two sides and open at the third: two edges, one pair of ends.
  const std::vector<Vector3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const TriangleMesh pocket(positions, {{0, 1, 2}, {0, 2, 1}}, {-1, 4, 3, 2, 1, -1});
  const BisectedMesh halved = bisect_long_edges(pocket, 10, {});
  EXPECT_EQ(halved.mesh.euler_characteristic(), pocket.euler_characteristic());
  EXPECT_FALSE(has_edges_with_common_ends(halved.mesh));
}

/// A strip of triangles and its back, on the same vertices, joined along their border: every edge across the strip is there twice.
TriangleMesh pillow(int triangles) {
  std::vector<Vector3> positions;
  for (int v = 0; v < triangles + 2; ++v) positions.emplace_back(v, v % 2, 0);
  std::vector<std::array<int, 3>> faces;
  for (int side = 0; side < 2; ++side)
    for (int v = 0; v < triangles; ++v) faces.push_back(v % 2 == side ? std::array<int, 3>{v, v + 1, v + 2} : std::array<int, 3>{v + 1, v, v + 2});
  std::vector<int> opposite(3 * faces.size(), -1);
  const auto from = [&](int h) { return faces[h / 3][h % 3]; };
  const auto to = [&](int h) { return faces[h / 3][(h + 1) % 3]; };
  for (int h = 0; h < static_cast<int>(opposite.size()); ++h)
    for (int o = 0; o < static_cast<int>(opposite.size()); ++o) {
      const bool is_across = std::abs(from(h) - to(h)) == 1 && std::min(from(h), to(h)) > 0 && std::max(from(h), to(h)) <= triangles;
      const bool same_side = (h / 3 < triangles) == (o / 3 < triangles);
      if (from(h) == to(o) && to(h) == from(o) && is_across == same_side) opposite[h] = o;
    }
  return TriangleMesh(positions, faces, opposite);
}

TEST(EdgeBisection, NeighboursWithCommonEndsAreHalvedOneByOne) {
  for (int triangles = 2; triangles < 30; ++triangles) {
    const TriangleMesh mesh = pillow(triangles);
    ASSERT_EQ(mesh.euler_characteristic(), 2);
    const BisectedMesh halved = bisect_long_edges(mesh, 10, {});
    EXPECT_FALSE(has_edges_with_common_ends(halved.mesh));
    EXPECT_EQ(halved.mesh.euler_characteristic(), 2);
    EXPECT_NEAR(halved.mesh.total_area(), mesh.total_area(), 1e-12 * mesh.total_area());
  }
}

TEST(EdgeBisection, ThinSurfacesAreNotCutIntoTooManyPieces) {
  const TriangleMesh ribbon = test::flat_grid(1, 1, 1.0, 1e-6);
  EXPECT_EQ(affordable_length(ribbon, 0.1, 1000), 0.1);
  const double length = affordable_length(ribbon, 1e-6, 1000);
  EXPECT_GT(length, 1e-3);
  EXPECT_LT(length, 1e-2);
}

TEST(EdgeBisection, ASearchForALengthEndsWithoutAnArea) {
  const TriangleMesh needle = test::flat_grid(1, 1, 1.0, 0.0);
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  affordable_length(needle, 1e-3, no_number);
  affordable_length(needle, no_number, 1000);
  affordable_length(needle, 0, 0);
}

}  // namespace
}  // namespace hybrid_quad
