#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/mesh/self_intersection.h"
#include "hybrid_quad/mesh/unit_frame.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

const Defect* find_defect(const std::vector<Defect>& defects, const std::string& code) {
  const auto found = std::find_if(defects.begin(), defects.end(), [&](const Defect& d) { return d.code == code; });
  return found == defects.end() ? nullptr : &*found;
}

/// Appends a moved copy of a mesh. \return the first vertex of the copy
int append(PolygonSoup& soup, const TriangleMesh& mesh, const Vector3& offset) {
  const int first = static_cast<int>(soup.positions.size());
  for (const Vector3& p : mesh.positions()) soup.positions.push_back(p + offset);
  for (const auto& f : mesh.faces()) {
    soup.face_sizes.push_back(3);
    for (const int v : f) soup.face_vertices.push_back(first + v);
  }
  return first;
}

std::vector<int> intersecting(const PolygonSoup& soup) {
  const std::vector<Defect> defects = check_mesh(soup);
  const Defect* found = find_defect(defects, "self_intersection");
  return found ? found->elements : std::vector<int>{};
}

TEST(SelfIntersection, SoundMeshesHaveNone) {
  for (const TriangleMesh& mesh : {test::torus(24, 12), test::icosphere(2), test::box(3), test::wedge(3, 5),
                                   test::capped_cylinder(64, 4), test::flat_grid(5, 5)})
    EXPECT_TRUE(self_intersecting_faces(SurfaceIndex(mesh, {})).faces.empty());
}

TEST(SelfIntersection, TwoBodiesAreFoundWhereTheirSurfacesMeetAtAnyScaleAndPlace) {
  for (const double scale : {1.0, 1e-30, 1e6}) {
    PolygonSoup soup = test::soup_of(test::icosphere(2));
    append(soup, test::icosphere(2), Vector3(0.9, 0.1, 0.05));
    for (Vector3& p : soup.positions) p = scale * (p + Vector3(10, 0, 0));
    const std::vector<int> faces = intersecting(soup);
    ASSERT_FALSE(faces.empty());
    // The spheres meet in the plane halfway: nothing that is far from it takes part.
    for (const int f : faces) {
      Vector3 middle = Vector3::Zero();
      for (int k = 0; k < 3; ++k) middle += soup.positions[soup.face_vertices[3 * f + k]] / (3 * scale);
      EXPECT_LT(std::abs((middle - Vector3(10.45, 0.05, 0.025)).dot(Vector3(0.9, 0.1, 0.05).normalized())), 0.3);
    }
  }
}

TEST(SelfIntersection, ApartOrTouchingIsNone) {
  PolygonSoup soup = test::soup_of(test::box(2));
  append(soup, test::box(2), Vector3(3, 0, 0));
  EXPECT_TRUE(check_mesh(soup).empty());
  PolygonSoup touching = test::soup_of(test::box(2));
  append(touching, test::icosphere(1), Vector3(0.3, 0.4, 2));  // its lowest vertex lies on the lid
  EXPECT_TRUE(intersecting(touching).empty());
}

TEST(SelfIntersection, FindsFacesFoldedOntoEachOther) {
  const TriangleMesh folded({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.4, 0.9, 0}}, {{0, 1, 2}, {1, 0, 3}});
  EXPECT_EQ(self_intersecting_faces(SurfaceIndex(folded, {})).faces, (std::vector<int>{0, 1}));
  const TriangleMesh flat({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.4, -0.9, 0}}, {{0, 1, 2}, {1, 0, 3}});
  EXPECT_TRUE(self_intersecting_faces(SurfaceIndex(flat, {})).faces.empty());
}

TEST(SelfIntersection, AgreesWithTryingAllPairs) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-1, 1);
  PolygonSoup soup;
  for (int f = 0; f < 60; ++f) {
    const Vector3 centre(at(random), at(random), at(random));
    for (int k = 0; k < 3; ++k) soup.positions.push_back(centre + 0.35 * Vector3(at(random), at(random), at(random)));
    soup.face_sizes.push_back(3);
    for (int k = 0; k < 3; ++k) soup.face_vertices.push_back(3 * f + k);
  }
  // An edge of one through the inside of the other, by signs of volumes.
  const auto volume = [&](int a, int b, int c, int d) {
    const auto& p = soup.positions;
    return (p[b] - p[a]).cross(p[c] - p[a]).dot(p[d] - p[a]);
  };
  const auto pierces = [&](int f, int g) {
    for (int i = 0; i < 3; ++i) {
      const int a = 3 * f + i, b = 3 * f + (i + 1) % 3, t = 3 * g;
      if ((volume(t, t + 1, t + 2, a) > 0) == (volume(t, t + 1, t + 2, b) > 0)) continue;
      const bool x = volume(a, b, t, t + 1) > 0, y = volume(a, b, t + 1, t + 2) > 0, z = volume(a, b, t + 2, t) > 0;
      if (x == y && y == z) return true;
    }
    return false;
  };
  std::vector<int> expected;
  for (int f = 0; f < 60; ++f)
    for (int g = 0; g < 60; ++g)
      if (f != g && (pierces(f, g) || pierces(g, f))) {
        expected.push_back(f);
        break;
      }
  ASSERT_GT(expected.size(), 5u);
  EXPECT_EQ(intersecting(soup), expected);
}

TEST(MeshOddities, AreListedButLeaveTheMeshAsItIs) {
  PolygonSoup soup = test::soup_of(test::box(2));
  const int first = append(soup, test::box(2), Vector3(1, 0, 0));  // side to side, not joined
  const std::vector<Defect> defects = check_mesh(soup);
  const Defect* touching = find_defect(defects, "touching_vertex");
  ASSERT_NE(touching, nullptr);
  EXPECT_TRUE(touching->repairable && touching->kept);
  EXPECT_EQ(touching->elements.size(), 18u);
  EXPECT_TRUE(std::any_of(touching->elements.begin(), touching->elements.end(), [&](int v) { return v >= first; }));
  const BuiltMesh built = build_mesh(soup);
  EXPECT_EQ(built.mesh.vertex_count(), static_cast<int>(soup.positions.size()));
  // Of these a run speaks as well: a program that welds by place sees another surface.
  const Defect* told = find_defect(built.defects, "touching_vertex");
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(told->elements, touching->elements);
  EXPECT_EQ(find_defect(build_mesh(test::soup_of(test::box(2))).defects, "touching_vertex"), nullptr);
}

TEST(MeshOddities, ACornerFarFromAllOthersIsNamed) {
  PolygonSoup soup = test::soup_of(test::icosphere(2));
  EXPECT_EQ(find_defect(check_mesh(soup), "far_vertex"), nullptr);
  soup.positions[7] *= 100;
  const std::vector<Defect> defects = check_mesh(soup);
  const Defect* far = find_defect(defects, "far_vertex");
  ASSERT_NE(far, nullptr);
  EXPECT_EQ(far->elements, std::vector<int>{7});
}

TEST(MeshOddities, ACornerFarFromAllOthersIsNamedWhereItsFaceHasNoArea) {
  PolygonSoup soup = test::soup_of(test::icosphere(2));
  const int far = static_cast<int>(soup.positions.size());
  soup.positions.push_back(Vector3(1e7, 0, 0));
  soup.face_sizes.push_back(3);
  soup.face_vertices.insert(soup.face_vertices.end(), {0, far, far});
  soup.face_sizes.push_back(3);
  soup.face_vertices.insert(soup.face_vertices.end(), {0, 0, far});
  bool is_named = false;
  for (const Defect& d : check_mesh(soup)) is_named |= d.code == "far_vertex" && d.elements == std::vector<int>{far};
  EXPECT_TRUE(is_named);
}

TEST(MeshOddities, CornersThatTouchFacesAndEdgesAreNamed) {
  for (const double scale : {1.0, 1e-20})
    for (const bool is_on_edge : {false, true}) {
      PolygonSoup soup;
      soup.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
      const Vector3 place = is_on_edge ? Vector3(2, 0, 0) : Vector3(2, 1, 0);
      for (const Vector3& p : {Vector3(0, 0, 0), Vector3(1, 0, 2), Vector3(0, 1, 2), Vector3(-1, -1, 2)}) soup.positions.push_back(place + p);
      for (Vector3& p : soup.positions) p *= scale;
      soup.face_sizes = {3, 3, 3, 3, 3, 3};
      soup.face_vertices = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6, 4, 5, 7, 5, 6, 7};
      std::vector<int> touching;
      for (const Defect& d : check_mesh(soup)) {
        EXPECT_NE(d.code, "self_intersection");
        if (d.code == "touching_vertex") touching = d.elements;
      }
      EXPECT_EQ(touching, std::vector<int>{4});
    }
}

TEST(MeshOddities, CutsAndFlatCornersTouchNothing) {
  for (const TriangleMesh& mesh : {test::box(3), test::torus(12, 8), test::capped_cylinder(40, 4)})
    for (const Defect& d : check_mesh(test::soup_of(mesh))) ADD_FAILURE() << d.code;
  PolygonSoup fin = test::soup_of(test::box(2));
  const int a = fin.face_vertices[0], b = fin.face_vertices[1];
  fin.positions.push_back(Vector3(3, 4, 5));
  fin.face_sizes.push_back(3);
  fin.face_vertices.insert(fin.face_vertices.end(), {a, b, static_cast<int>(fin.positions.size()) - 1});
  for (const Defect& d : check_mesh(fin)) EXPECT_NE(d.code, "touching_vertex");
}

TEST(UnitFrame, PutsEverythingBetweenMinusOneAndOneAndBack) {
  const TriangleMesh torus = test::torus(8, 6);
  for (const double scale : {1e-300, 1e-30, 0.7, 1.0, 1e6, 1e300})
    for (const double offset : {0.0, 3.0, 1e6}) {
      std::vector<Vector3> points;
      for (const Vector3& p : torus.positions()) points.push_back(scale * (p + Vector3(offset, -offset, 0)));
      for (const bool keep_origin : {false, true}) {
        const UnitFrame frame = unit_frame_of(points, keep_origin);
        double largest = 0;
        for (const Vector3& p : points) {
          largest = std::max(largest, frame.inward(p).cwiseAbs().maxCoeff());
          EXPECT_LE((frame.outward(frame.inward(p)) - p).cwiseAbs().maxCoeff(), 4e-16 * scale * (offset + 2));
          if (keep_origin) {
            EXPECT_EQ(frame.outward(frame.inward(p)), p);
          }
        }
        EXPECT_LE(largest, 1);
        EXPECT_GE(largest, 0.5);
        EXPECT_EQ(keep_origin || offset == 0, frame.centre.cwiseAbs().maxCoeff() <= 1e-9 * scale);
      }
    }
}

TEST(UnitFrame, PowersOfTwoMakeNoDifference) {
  const std::vector<Vector3> points = test::torus(8, 6).positions();
  const UnitFrame usual = unit_frame_of(points, false);
  for (const int exponent : {-300, -7, 1, 40}) {
    std::vector<Vector3> scaled = points;
    for (Vector3& p : scaled) p *= std::ldexp(1.0, exponent);
    const UnitFrame frame = unit_frame_of(scaled, false);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(frame.inward(scaled[i]), usual.inward(points[i]));
  }
}

TEST(MeshOddities, WhereTheSearchForIntersectionsEndsEarlyCheckSaysSo) {
  PolygonSoup fan;
  const int count = 9000;
  fan.positions.push_back(Vector3::Zero());
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * EIGEN_PI * i / count;
    fan.positions.push_back(Vector3(std::cos(angle), std::sin(angle), 0));
    fan.face_sizes.push_back(3);
    for (const int v : {0, i + 1, (i + 1) % count + 1}) fan.face_vertices.push_back(v);
  }
  const std::vector<Defect> defects = check_mesh(fan);
  ASSERT_NE(find_defect(defects, "unknown_intersection"), nullptr);
  EXPECT_EQ(find_defect(defects, "self_intersection"), nullptr);
  EXPECT_EQ(find_defect(check_mesh(test::soup_of(test::icosphere(3))), "unknown_intersection"), nullptr);
}

}  // namespace
}  // namespace hybrid_quad
