#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/mesh/polygon_triangulation.h"

namespace hybrid_quad {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// Each from its least corner on, in order.
Triangles sorted(Triangles triangles) {
  for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// A square and a corner above the middle of its last side: seen along its normal, that corner lies on the side.
const std::vector<Vector3> kFolded{{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, {0, 1, -1}};

TEST(PolygonTriangulation, APolygonThatTouchesItselfInItsPlaneIsAFan) {
  for (int first = 0; first < 5; ++first) {
    Triangles fan;
    for (int i = 1; i < 4; ++i) fan.push_back({first, (first + i) % 5, (first + i + 1) % 5});
    EXPECT_EQ(sorted(triangulate_polygon(kFolded, {0, 1, 2, 3, 4}, first)), sorted(fan)) << first;
  }
}

TEST(PolygonTriangulation, TheFanBeginsAtThePolygonsFirstCorner) {
  for (int first = 0; first < 5; ++first) {
    PolygonSoup soup;
    soup.positions = kFolded;
    for (int i = 0; i < 5; ++i) soup.face_vertices.push_back((first + i) % 5);
    soup.face_sizes = {5};
    const BuiltMesh built = build_mesh(soup);
    ASSERT_EQ(built.mesh.face_count(), 3);
    int at_first = 0;
    for (int f = 0; f < 3; ++f)
      for (const int v : built.mesh.face(f)) at_first += built.input_vertex[v] == first;
    EXPECT_EQ(at_first, 3) << first;
  }
}

TEST(PolygonTriangulation, ConcavePolygonsAreNoFans) {
  const std::vector<Vector3> arrow{{0, 0, 0}, {2, -1, 0}, {0, 2, 0}, {-2, -1, 0}};
  for (int first = 0; first < 4; ++first)
    EXPECT_EQ(sorted(triangulate_polygon(arrow, {0, 1, 2, 3}, first)), (Triangles{{0, 1, 2}, {0, 2, 3}})) << first;
}

TEST(PolygonTriangulation, ABentPolygonIsAFanAsInMostReaders) {
  const std::vector<Vector3> quad{{0, 0, 0}, {1, 0, 0.2}, {1, 1, 0}, {0, 1, 0.2}};
  for (int first = 0; first < 4; ++first) {
    const Triangles fan{{first, (first + 1) % 4, (first + 2) % 4}, {first, (first + 2) % 4, (first + 3) % 4}};
    EXPECT_EQ(sorted(triangulate_polygon(quad, {0, 1, 2, 3}, first)), sorted(fan)) << first;
  }
  std::vector<Vector3> pentagon;
  for (int i = 0; i < 5; ++i) pentagon.push_back({std::cos(1.2 * i), std::sin(1.2 * i), i % 2 == 0 ? 0.0 : 0.1});
  for (int first = 0; first < 5; ++first) {
    Triangles fan;
    for (int i = 1; i < 4; ++i) fan.push_back({first, (first + i) % 5, (first + i + 1) % 5});
    EXPECT_EQ(sorted(triangulate_polygon(pentagon, {0, 1, 2, 3, 4}, first)), sorted(fan)) << first;
  }
}

TEST(PolygonTriangulation, ABentConcaveQuadIsCutAtItsConcaveCorner) {
  const std::vector<Vector3> arrow{{0, 0, 0.1}, {2, -1, 0}, {0, 2, 0}, {-2, -1, 0}};
  for (int first = 0; first < 4; ++first)
    EXPECT_EQ(sorted(triangulate_polygon(arrow, {0, 1, 2, 3}, first)), (Triangles{{0, 1, 2}, {0, 2, 3}})) << first;
}

TEST(PolygonTriangulation, AFlatQuadIsCutAlikeWhereverItBegins) {
  const std::vector<Vector3> quad{{0, 0, 0}, {2, 0, 0}, {3, 1, 1e-6}, {0, 1, 0}};
  const Triangles cut = sorted(triangulate_polygon(quad, {0, 1, 2, 3}, 0));
  for (int first = 1; first < 4; ++first) EXPECT_EQ(sorted(triangulate_polygon(quad, {0, 1, 2, 3}, first)), cut) << first;
}

TEST(PolygonTriangulation, CornersInOnePlaceOrOnASideStillLeaveThePolygonItsSurface) {
  const std::vector<Vector3> points{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 0}, {1, 1, 0}};
  for (int first = 0; first < 5; ++first) {
    double area = 0;
    for (const auto& t : triangulate_polygon(points, {0, 1, 2, 3, 4}, first))
      area += 0.5 * (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).z();
    EXPECT_NEAR(area, 2, 1e-12) << first;
  }
}

}  // namespace
}  // namespace hybrid_quad
