#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/degenerate_faces.h"
#include "hybrid_quad/mesh/editable_mesh.h"
#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/mesh/polygon_cuts.h"
#include "hybrid_quad/mesh/topology.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

bool has_defect(const std::vector<Defect>& defects, const std::string& code) {
  return std::any_of(defects.begin(), defects.end(), [&](const Defect& d) { return d.code == code; });
}

std::string refusal(const PolygonSoup& soup) {
  try {
    build_mesh(soup);
  } catch (const InputError& e) {
    EXPECT_TRUE(has_defect(check_mesh(soup), e.code));
    return e.code;
  }
  return "";
}

double signed_volume(const TriangleMesh& m) {
  double v = 0;
  for (const auto& f : m.faces()) v += m.position(f[0]).dot(m.position(f[1]).cross(m.position(f[2]))) / 6;
  return v;
}

int boundary_edges(const TriangleMesh& m) {
  return static_cast<int>(std::count(m.opposites().begin(), m.opposites().end(), -1));
}

void flip_face(PolygonSoup& soup, int f) { std::swap(soup.face_vertices[3 * f + 1], soup.face_vertices[3 * f + 2]); }

PolygonSoup loose(const PolygonSoup& soup) {
  PolygonSoup s;
  for (const int v : soup.face_vertices) {
    s.face_vertices.push_back(static_cast<int>(s.positions.size()));
    s.positions.push_back(soup.positions[v]);
  }
  s.face_sizes = soup.face_sizes;
  return s;
}

void add_face(PolygonSoup& soup, std::vector<int> corners) {
  soup.face_sizes.push_back(static_cast<int>(corners.size()));
  soup.face_vertices.insert(soup.face_vertices.end(), corners.begin(), corners.end());
}

/// The same surface with vertices, faces and the faces' first corners in another order.
PolygonSoup shuffled(const PolygonSoup& soup, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> place(soup.positions.size()), order(soup.face_sizes.size());
  std::iota(place.begin(), place.end(), 0);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  std::shuffle(order.begin(), order.end(), random);
  PolygonSoup s;
  s.positions.resize(place.size());
  for (std::size_t v = 0; v < place.size(); ++v) s.positions[place[v]] = soup.positions[v];
  for (const int f : order) {
    const int first = static_cast<int>(random() % 3);
    std::vector<int> corners;
    for (int i = 0; i < 3; ++i) corners.push_back(place[soup.face_vertices[3 * f + (first + i) % 3]]);
    add_face(s, corners);
  }
  return s;
}

TEST(MeshBuilder, OrderOfTheFileMakesNoDifference) {
  PolygonSoup soup = test::soup_of(test::torus(12, 8));
  const PolygonSoup other = test::soup_of(test::icosphere(2, 0.3));
  const int first = static_cast<int>(soup.positions.size());
  soup.positions.insert(soup.positions.end(), other.positions.begin(), other.positions.end());
  for (std::size_t f = 0; f < other.face_sizes.size(); ++f)
    add_face(soup, {first + other.face_vertices[3 * f], first + other.face_vertices[3 * f + 1], first + other.face_vertices[3 * f + 2]});
  const BuiltMesh usual = build_mesh(soup);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const PolygonSoup mixed = shuffled(soup, seed);
    const BuiltMesh built = build_mesh(mixed);
    EXPECT_EQ(built.mesh.faces(), usual.mesh.faces());
    EXPECT_EQ(built.mesh.opposites(), usual.mesh.opposites());
    EXPECT_EQ(built.mesh.positions(), usual.mesh.positions());
    for (int v = 0; v < built.mesh.vertex_count(); ++v)
      EXPECT_EQ(mixed.positions[built.input_vertex[v]], built.mesh.position(v));
    for (int f = 0; f < built.mesh.face_count(); ++f)
      for (const int v : built.mesh.face(f)) {
        const int* corners = &mixed.face_vertices[3 * built.input_face[f]];
        EXPECT_NE(std::find(corners, corners + 3, built.input_vertex[v]), corners + 3);
      }
  }
}

/// Faces whose least vertex comes first, in an order of their own.
std::vector<std::array<int, 3>> cyclic(std::vector<std::array<int, 3>> faces) {
  for (auto& f : faces) std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// The faces by the input's vertices.
std::vector<std::array<int, 3>> input_faces(const BuiltMesh& built) {
  std::vector<std::array<int, 3>> faces = built.mesh.faces();
  for (auto& f : faces)
    for (int& v : f) v = built.input_vertex[v];
  return cyclic(std::move(faces));
}

TEST(MeshBuilder, LeavesACleanMeshAlone) {
  const TriangleMesh torus = test::torus(12, 8);
  for (const double scale : {1.0, 1e-30, 1e20}) {
    PolygonSoup soup = test::soup_of(torus);
    for (Vector3& p : soup.positions) p *= scale;
    const BuiltMesh built = build_mesh(soup);
    EXPECT_TRUE(built.defects.empty());
    EXPECT_EQ(input_faces(built), cyclic(torus.faces()));
    for (int v = 0; v < built.mesh.vertex_count(); ++v)
      EXPECT_EQ(built.mesh.position(v), soup.positions[built.input_vertex[v]]);
  }
}

TEST(MeshBuilder, TriangulatesConcavePolygons) {
  PolygonSoup soup;
  soup.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
  add_face(soup, {0, 1, 2, 3, 4});
  const BuiltMesh built = build_mesh(soup);
  EXPECT_EQ(built.mesh.face_count(), 3);
  EXPECT_NEAR(built.mesh.total_area(), 10, 1e-12);
  for (int f = 0; f < 3; ++f) {
    EXPECT_GT(built.mesh.area_normal(f).z(), 0);
    EXPECT_EQ(built.input_face[f], 0);
  }
}

TEST(MeshBuilder, OrientsMixedFacesOutwards) {
  const TriangleMesh sphere = test::icosphere(2);
  PolygonSoup soup = test::soup_of(sphere);
  for (int f = 0; f < sphere.face_count(); ++f)
    if (f % 3) flip_face(soup, f);
  const BuiltMesh built = build_mesh(soup);
  EXPECT_TRUE(has_defect(built.defects, "flipped_face"));
  EXPECT_EQ(built.mesh.euler_characteristic(), 2);
  EXPECT_GT(signed_volume(built.mesh), 0);
}

TEST(MeshBuilder, KeepsAConsistentInwardOrientation) {
  PolygonSoup soup = test::soup_of(test::icosphere(1));
  for (int f = 0; f < static_cast<int>(soup.face_sizes.size()); ++f) flip_face(soup, f);
  const BuiltMesh built = build_mesh(soup);
  EXPECT_TRUE(built.defects.empty());
  EXPECT_LT(signed_volume(built.mesh), 0);
}

TEST(MeshBuilder, WeldsLooseTriangles) {
  const TriangleMesh torus = test::torus(16, 8);
  PolygonSoup soup = loose(test::soup_of(torus));
  EXPECT_EQ(build_mesh(soup).mesh.euler_characteristic(), 0);
  EXPECT_EQ(build_mesh(soup).mesh.vertex_count(), torus.vertex_count());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter(-1e-6, 1e-6);
  for (Vector3& p : soup.positions) p += Vector3(jitter(random), jitter(random), jitter(random));
  const BuiltMesh built = build_mesh(soup);
  EXPECT_TRUE(has_defect(built.defects, "nearly_welded_vertex"));
  EXPECT_EQ(built.mesh.vertex_count(), torus.vertex_count());
  EXPECT_EQ(boundary_edges(built.mesh), 0);
}

/// As programs make it from angles: a vertex for each meridian at the poles, the last meridian beside the first, where a whole turn ends but
/// for rounding. \param rounded  to single precision, in which the poles are as wide as the sine of pi
PolygonSoup unrolled_sphere(int around, int along, bool with_flat_faces, bool rounded) {
  PolygonSoup soup;
  const double pi = std::acos(-1.0);
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i <= around; ++i) {
      const double t = 2 * pi * i / around, p = pi * j / along;
      if (rounded) {
        const auto turn = static_cast<float>(t), height = static_cast<float>(p);
        soup.positions.emplace_back(std::cos(turn) * std::sin(height), std::sin(turn) * std::sin(height), std::cos(height));
      } else {
        soup.positions.emplace_back(std::cos(t) * std::sin(p), std::sin(t) * std::sin(p), std::cos(p));
      }
    }
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      const int a = j * (around + 1) + i, b = a + around + 1;
      if (with_flat_faces || j > 0) add_face(soup, {a, b, a + 1});
      if (with_flat_faces || j + 1 < along) add_face(soup, {b, b + 1, a + 1});
    }
  return soup;
}

TEST(MeshBuilder, ClosesPolesAndTheSeamOfATurn) {
  for (const bool with_flat_faces : {false, true})
    for (const bool rounded : {false, true}) {
      const PolygonSoup soup = unrolled_sphere(24, 12, with_flat_faces, rounded);
      const BuiltMesh built = build_mesh(soup);
      EXPECT_EQ(built.mesh.vertex_count(), 24 * 11 + 2) << with_flat_faces << rounded;
      EXPECT_EQ(built.mesh.euler_characteristic(), 2);
      EXPECT_EQ(boundary_edges(built.mesh), 0);
      EXPECT_TRUE(has_defect(built.defects, "nearly_welded_vertex"));
      EXPECT_EQ(has_defect(built.defects, "pinhole"), with_flat_faces) << "else the poles close with the meridians";
    }
}

TEST(MeshBuilder, KeepsHolesAndSlitsThatAreThere) {
  const PolygonSoup sphere = test::soup_of(test::icosphere(2));
  const auto rim_width = [&](double width) {
    PolygonSoup soup = sphere;
    for (const int v : {0, 1, 2}) {
      const Vector3 towards = soup.positions[sphere.face_vertices[0]];
      soup.positions[sphere.face_vertices[v]] = towards + width * (soup.positions[sphere.face_vertices[v]] - towards);
    }
    soup.face_sizes.erase(soup.face_sizes.begin());
    soup.face_vertices.erase(soup.face_vertices.begin(), soup.face_vertices.begin() + 3);
    return build_mesh(soup);
  };
  EXPECT_EQ(boundary_edges(rim_width(1e-2).mesh), 3);
  EXPECT_EQ(boundary_edges(rim_width(2e-5).mesh), 3);
  const BuiltMesh closed = rim_width(1e-7);
  EXPECT_EQ(boundary_edges(closed.mesh), 0);
  EXPECT_TRUE(has_defect(closed.defects, "pinhole"));

  PolygonSoup slit = loose(test::soup_of(test::torus(16, 8)));
  for (int c = 0; c < 3; ++c) slit.positions[c] += Vector3::Constant(1e-4);
  EXPECT_EQ(boundary_edges(build_mesh(slit).mesh), 6) << "a loose face beside a hole of its size";
}

TEST(MeshBuilder, PartsSmallBesideOneVertexKeepTheirHoles) {
  PolygonSoup soup = test::soup_of(test::torus(12, 8));
  soup.face_sizes.erase(soup.face_sizes.begin());
  soup.face_vertices.erase(soup.face_vertices.begin(), soup.face_vertices.begin() + 3);
  for (Vector3& p : soup.positions) p *= 1e-7;
  const int first = static_cast<int>(soup.positions.size());
  for (const Vector3& p : {Vector3(1, 0, 0), Vector3(1, 1, 0), Vector3(0, 1, 0)}) soup.positions.push_back(p);
  add_face(soup, {first, first + 1, first + 2});
  const BuiltMesh built = build_mesh(soup);
  EXPECT_FALSE(has_defect(built.defects, "pinhole")) << "its edges are as short";
}

/// Both, each with vertices of its own; the second one moved, and with its back to the front.
PolygonSoup with_inverted_copy(PolygonSoup soup, const Vector3& shift = Vector3::Zero()) {
  const PolygonSoup copy = soup;
  const int n = static_cast<int>(copy.positions.size());
  for (const Vector3& p : copy.positions) soup.positions.push_back(p + shift);
  for (std::size_t f = 0; f < copy.face_sizes.size(); ++f)
    add_face(soup, {n + copy.face_vertices[3 * f], n + copy.face_vertices[3 * f + 2], n + copy.face_vertices[3 * f + 1]});
  return soup;
}

TEST(MeshBuilder, LeavesOutAPartThatLiesOnAnother) {
  PolygonSoup inward = test::soup_of(test::box(2));
  for (int f = 0; f < static_cast<int>(inward.face_sizes.size()); ++f) flip_face(inward, f);
  for (const PolygonSoup& box : {test::soup_of(test::box(2)), inward}) {
    const BuiltMesh built = build_mesh(with_inverted_copy(box));
    EXPECT_EQ(built.mesh.euler_characteristic(), 2);
    EXPECT_NEAR(signed_volume(built.mesh), 1, 1e-12) << "that which faces outwards stays";
    ASSERT_TRUE(has_defect(built.defects, "duplicate_face"));
    EXPECT_EQ(built.defects.front().elements.size(), box.face_sizes.size());
  }
  // A sheet with a back to every face is open still, however its file came to be.
  const PolygonSoup sheet = test::soup_of(test::flat_grid(4, 4));
  for (const PolygonSoup& card : {with_inverted_copy(sheet), loose(with_inverted_copy(sheet))}) {
    const BuiltMesh built = build_mesh(card);
    EXPECT_EQ(built.mesh.euler_characteristic(), 1);
    EXPECT_NEAR(built.mesh.total_area(), 1, 1e-12);
    EXPECT_EQ(boundary_edges(built.mesh), 16);
  }
}

TEST(MeshBuilder, KeepsClosedBodiesApartThatLieOnEachOtherInPart) {
  const PolygonSoup box = test::soup_of(test::box(2));
  const BuiltMesh built = build_mesh(with_inverted_copy(box, Vector3(1, 0, 0)));
  EXPECT_EQ(built.mesh.euler_characteristic(), 4);
  EXPECT_EQ(boundary_edges(built.mesh), 0);
  EXPECT_FALSE(has_defect(built.defects, "duplicate_face"));
}

TEST(MeshBuilder, DropsCopiesAndRepeatedCorners) {
  const TriangleMesh sphere = test::icosphere(1);
  PolygonSoup soup = test::soup_of(sphere);
  const auto f = sphere.face(5), g = sphere.face(9);
  add_face(soup, {f[1], f[2], f[0]});
  add_face(soup, {g[0], g[2], g[1]});
  add_face(soup, {3, 3, 4});
  const BuiltMesh built = build_mesh(soup);
  EXPECT_TRUE(has_defect(built.defects, "duplicate_face"));
  EXPECT_TRUE(has_defect(built.defects, "repeated_index_face"));
  EXPECT_EQ(input_faces(built), cyclic(sphere.faces()));
}

/// A polygon from another corner on, or the other way round.
std::vector<int> turned(std::vector<int> polygon, int by, bool is_reversed) {
  std::rotate(polygon.begin(), polygon.begin() + by, polygon.end());
  if (is_reversed) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

TEST(MeshBuilder, DropsCopiesOfPolygonsFromAnyCornerAndEitherWayRound) {
  for (const int corners : {4, 5, 6, 24})
    for (const double bend : {0.0, 0.3})
      for (const int by : {0, 1, 3})
        for (const bool is_reversed : {false, true})
          for (const bool has_own_vertices : {false, true}) {
            PolygonSoup soup;
            std::vector<int> polygon;
            for (int i = 0; i < corners; ++i) {
              const double angle = 2 * 3.14159265358979 * i / corners;
              soup.positions.push_back(Vector3(std::cos(angle), std::sin(angle), i % 2 * bend));
              polygon.push_back(i);
            }
            add_face(soup, polygon);
            const double area = build_mesh(soup).mesh.total_area();
            std::vector<int> copy = turned(polygon, by, is_reversed);
            if (has_own_vertices) {
              for (int i = 0; i < corners; ++i) soup.positions.push_back(Vector3(soup.positions[i]));
              for (int& v : copy) v += corners;
            }
            add_face(soup, copy);
            const BuiltMesh built = build_mesh(soup);
            EXPECT_EQ(topology_of(built.mesh), (Topology{1, 1, 1})) << corners << " " << bend << " " << by;
            EXPECT_TRUE(has_defect(built.defects, "duplicate_face"));
            EXPECT_FALSE(has_defect(built.defects, "non_manifold_edge"));
            if (bend == 0 || (!is_reversed && by == 0)) {
              EXPECT_NEAR(built.mesh.total_area(), area, 1e-12);
            }
          }
}

TEST(PolygonCuts, TheSameCornersInAnotherCycleAreNoCopy) {
  PolygonSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  add_face(soup, {0, 1, 2, 3});
  add_face(soup, {0, 2, 1, 3});
  add_face(soup, {1, 0, 3, 2});
  PolygonCuts cuts(soup.positions, soup);
  cuts.keep(0, {0, 1, 2, 3}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_TRUE(cuts.like_a_copy(1, {0, 2, 1, 3}).empty());
  EXPECT_EQ(cuts.like_a_copy(2, {1, 0, 3, 2}), (std::vector<std::array<int, 3>>{{0, 2, 1}, {0, 3, 2}}));
}

TEST(MeshBuilder, SplitsNonManifoldEdgesAndVertices) {
  const TriangleMesh sphere = test::icosphere(1);
  PolygonSoup fin = test::soup_of(sphere);
  fin.positions.push_back(1.5 * (sphere.position(sphere.from(0)) + sphere.position(sphere.to(0))));
  add_face(fin, {sphere.from(0), sphere.to(0), sphere.vertex_count()});
  const BuiltMesh built = build_mesh(fin);
  EXPECT_TRUE(has_defect(built.defects, "non_manifold_edge"));
  EXPECT_EQ(built.mesh.euler_characteristic(), 3);  // the sphere and the fin, apart
  EXPECT_EQ(boundary_edges(built.mesh), 3);

  PolygonSoup bow;
  bow.positions = {{0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}, {-1, -1, 0}};
  add_face(bow, {0, 2, 1});
  add_face(bow, {0, 3, 4});
  const BuiltMesh split = build_mesh(bow);
  EXPECT_TRUE(has_defect(split.defects, "non_manifold_vertex"));
  EXPECT_EQ(split.mesh.vertex_count(), 6);
  std::vector<int> sources = split.input_vertex;
  std::sort(sources.begin(), sources.end());
  EXPECT_EQ(sources, (std::vector<int>{0, 0, 1, 2, 3, 4}));
}

TEST(MeshBuilder, ResolvesFacesWithoutAreaWithoutOpeningHoles) {
  // A vertex in the middle of an edge, closed by a collinear triangle.
  const TriangleMesh sphere = test::icosphere(1);
  PolygonSoup soup = test::soup_of(sphere);
  const int a = sphere.from(0), b = sphere.to(0), c = sphere.to(1), m = sphere.vertex_count();
  soup.positions.push_back(0.5 * (sphere.position(a) + sphere.position(b)));
  soup.face_vertices[0] = a, soup.face_vertices[1] = m, soup.face_vertices[2] = c;
  add_face(soup, {m, b, c});
  add_face(soup, {a, b, m});
  const BuiltMesh built = build_mesh(soup);
  EXPECT_TRUE(has_defect(built.defects, "zero_area_face"));
  EXPECT_EQ(boundary_edges(built.mesh), 0);
  EXPECT_EQ(built.mesh.euler_characteristic(), 2);
  for (const auto& f : built.mesh.faces())
    EXPECT_FALSE(has_no_area(built.mesh.position(f[0]), built.mesh.position(f[1]), built.mesh.position(f[2])));
}

TEST(MeshBuilder, TakesWhiskersAway) {
  // A collinear polygon in a row of quads beyond the ends of the one edge that it has in common with them.
  PolygonSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}};
  add_face(soup, {0, 1, 4, 3});
  add_face(soup, {1, 2, 5, 4});
  for (const auto& whisker : {std::vector<int>{0, 1, 8}, std::vector<int>{1, 0, 8, 7, 6, 2}, std::vector<int>{2, 1, 7, 8}}) {
    PolygonSoup with = soup;
    add_face(with, whisker);
    const BuiltMesh built = build_mesh(with);
    EXPECT_EQ(topology_of(built.mesh), (Topology{1, 1, 1}));
    EXPECT_NEAR(built.mesh.total_area(), 2, 1e-9);
    EXPECT_TRUE(faces_without_area(built.mesh).empty());
    EXPECT_TRUE(has_defect(built.defects, "zero_area_face"));
    EXPECT_FALSE(has_defect(built.defects, "non_manifold_edge"));
  }
}

TEST(MeshBuilder, TakesFacesWithoutAreaAwayAtTheBorder) {
  // Its longest side, the only open one, cannot be flipped.
  PolygonSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
  add_face(soup, {0, 1, 3});
  add_face(soup, {1, 2, 3});
  add_face(soup, {0, 2, 1});
  const BuiltMesh built = build_mesh(soup);
  EXPECT_EQ(topology_of(built.mesh), (Topology{1, 1, 1}));
  EXPECT_EQ(built.mesh.face_count(), 2);
  EXPECT_EQ(boundary_edges(built.mesh), 4);
  EXPECT_TRUE(faces_without_area(built.mesh).empty());
}

TEST(MeshBuilder, TellsWhichFacesWithoutAreaStay) {
  // A torus with a part of its tube collapsed to a line: without it, it would be a sphere.
  const TriangleMesh ring = test::torus(24, 12);
  std::vector<Vector3> positions = ring.positions();
  for (Vector3& p : positions)
    if (p[0] > 0) p = Vector3(1, p[1], 0);
  const BuiltMesh built = build_mesh(test::soup_of(TriangleMesh(positions, ring.faces(), ring.opposites())));
  EXPECT_EQ(topology_of(built.mesh), (Topology{1, 0, 0}));
  std::size_t gone = 0, left = 0;
  for (const Defect& defect : built.defects)
    if (defect.code == "zero_area_face") (defect.kept ? left : gone) += defect.elements.size();
  EXPECT_GT(gone, 0U);
  EXPECT_GE(left, 1U);
  EXPECT_LE(left, faces_without_area(built.mesh).size());
}

TEST(MeshBuilder, ClosesCracksOfZeroWidth) {
  // A vertex in the middle of an edge of one face only: the other face does not know of it.
  const TriangleMesh sphere = test::icosphere(1);
  PolygonSoup soup = test::soup_of(sphere);
  const int a = sphere.from(0), b = sphere.to(0), c = sphere.to(1), m = sphere.vertex_count();
  soup.positions.push_back(0.5 * (sphere.position(a) + sphere.position(b)));
  soup.face_vertices[0] = a, soup.face_vertices[1] = m, soup.face_vertices[2] = c;
  add_face(soup, {m, b, c});
  const BuiltMesh built = build_mesh(soup);
  EXPECT_TRUE(has_defect(built.defects, "t_junction"));
  EXPECT_EQ(boundary_edges(built.mesh), 0);
  EXPECT_EQ(built.mesh.euler_characteristic(), 2);
}

TEST(MeshBuilder, RefusesWhatIsNoSurface) {
  const PolygonSoup good = test::soup_of(test::icosphere(2));
  EXPECT_EQ(refusal(PolygonSoup{}), "empty_mesh");
  PolygonSoup bad = good;
  bad.positions[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(bad), "non_finite_vertex");
  bad.positions[3].y() = 1e30;
  EXPECT_EQ(refusal(bad), "coordinate_outlier");
  bad = good;
  bad.face_vertices[7] = 100000;
  EXPECT_EQ(refusal(bad), "index_out_of_range");
  bad.face_vertices[7] = -1;
  EXPECT_EQ(refusal(bad), "index_out_of_range");
  bad = good;
  for (Vector3& p : bad.positions) p = Vector3(1, 2, 3);
  EXPECT_EQ(refusal(bad), "no_area");
  bad = good;
  for (Vector3& p : bad.positions) p = Vector3(p.x(), 0, 0);
  EXPECT_EQ(refusal(bad), "no_area");
  bad = good;
  bad.face_sizes[0] = 4;
  EXPECT_EQ(refusal(bad), "malformed_faces");
}

TEST(MeshBuilder, RefusesWhatHasTooFewDigitsForItsQuads) {
  const auto far = [](PolygonSoup soup, const Vector3& size) {
    for (Vector3& p : soup.positions) p = p.cwiseProduct(size) + Vector3(300, -500, 900);
    return soup;
  };
  const auto far_torus = [&](double size) { return far(test::soup_of(test::torus(12, 8)), Vector3::Constant(size)); };
  const auto far_strip = [&](double width) { return far(test::soup_of(test::flat_grid(20, 2)), Vector3(1e-5, width, 1)); };
  EXPECT_EQ(refusal(far_torus(1e-7)), "coordinates_too_coarse");
  EXPECT_EQ(refusal(far_torus(1e-5)), "");
  EXPECT_EQ(refusal(far_strip(1e-8)), "coordinates_too_coarse");
  EXPECT_EQ(refusal(far_strip(1e-6)), "");
}

TEST(MeshBuilder, RefusesAMoebiusStrip) {
  PolygonSoup strip;
  const int n = 12;
  for (int i = 0; i < n; ++i) {
    const double t = 2 * 3.14159265358979 * i / n;
    for (const double w : {-0.3, 0.3})
      strip.positions.emplace_back((1 + w * std::cos(t / 2)) * std::cos(t), (1 + w * std::cos(t / 2)) * std::sin(t),
                                   w * std::sin(t / 2));
  }
  for (int i = 0; i + 1 < n; ++i) add_face(strip, {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
  add_face(strip, {2 * n - 2, 1, 0, 2 * n - 1});
  EXPECT_EQ(refusal(strip), "non_orientable");
}

/// A sphere with a tube inside, from one face to another, that is joined inside out at its second end.
PolygonSoup sphere_with_twisted_tube(int levels) {
  const TriangleMesh sphere = test::icosphere(levels);
  const int first = 0, second = sphere.face_count() / 2;
  PolygonSoup soup;
  soup.positions = sphere.positions();
  for (int f = 0; f < sphere.face_count(); ++f)
    if (f != first && f != second) add_face(soup, {sphere.face(f)[0], sphere.face(f)[1], sphere.face(f)[2]});
  const auto &a = sphere.face(first), &b = sphere.face(second);
  for (int i = 0; i < 3; ++i) add_face(soup, {a[i], a[(i + 1) % 3], b[(i + 1) % 3], b[i]});
  return soup;
}

TEST(MeshBuilder, CutsShortTwistsOpen) {
  const PolygonSoup soup = sphere_with_twisted_tube(4);
  const BuiltMesh built = build_mesh(soup);
  EXPECT_EQ(built.mesh.face_count(), static_cast<int>(soup.face_sizes.size()) + 3) << "nothing is left out";
  EXPECT_EQ(built.mesh.euler_characteristic(), 0);
  EXPECT_EQ(boundary_edges(built.mesh), 2 * 3) << "both sides of the cut";
  EXPECT_GT(signed_volume(built.mesh), 3) << "the sphere faces outwards as it did";
  const auto twisted = std::find_if(built.defects.begin(), built.defects.end(), [](const Defect& d) { return d.code == "twisted_edge"; });
  ASSERT_NE(twisted, built.defects.end());
  EXPECT_TRUE(twisted->repairable);
  EXPECT_EQ(twisted->element_kind, "edge");
  EXPECT_EQ(std::set<int>(twisted->elements.begin(), twisted->elements.end()).size(), 3u);
  EXPECT_FALSE(has_defect(built.defects, "flipped_face"));
}

TEST(MeshBuilder, TellsFlippedFacesFromTwists) {
  PolygonSoup soup = test::soup_of(test::icosphere(4));
  for (const int f : {7, 8, 200, 411}) flip_face(soup, f);
  EXPECT_FALSE(has_defect(build_mesh(soup).defects, "twisted_edge"));
  soup = sphere_with_twisted_tube(4);
  for (const int f : {100, 300, 500}) flip_face(soup, f);
  const BuiltMesh built = build_mesh(soup);
  EXPECT_TRUE(has_defect(built.defects, "twisted_edge"));
  EXPECT_TRUE(has_defect(built.defects, "flipped_face"));
  EXPECT_EQ(boundary_edges(built.mesh), 2 * 3);
}

TEST(MeshBuilder, RefusesTwistsThatAreLong) { EXPECT_EQ(refusal(sphere_with_twisted_tube(1)), "non_orientable"); }

TEST(MeshBuilder, EveryBadModelIsBuiltOrRefused) {
  const std::string folder = test::models_folder();
  const auto bad = std::filesystem::path(folder).parent_path() / "bad";
  if (folder.empty() || !std::filesystem::is_directory(bad)) GTEST_SKIP();
  for (const auto& entry : std::filesystem::directory_iterator(bad)) {
    if (entry.path().extension() != ".obj") continue;
    SCOPED_TRACE(entry.path().filename().string());
    try {
      const BuiltMesh built = build_mesh(test::read_obj(entry.path().string()));
      EXPECT_GT(built.mesh.total_area(), 0);
      EXPECT_EQ(static_cast<int>(built.input_vertex.size()), built.mesh.vertex_count());
      EXPECT_EQ(static_cast<int>(built.input_face.size()), built.mesh.face_count());
    } catch (const InputError& e) {
      EXPECT_FALSE(e.code.empty());
    }
  }
}

TEST(EditableMesh, RandomOperationsKeepTheTopology) {
  for (const TriangleMesh& start : {test::torus(12, 8), test::open_cylinder(12, 5), test::icosphere(2)}) {
    EditableMesh m(start);
    std::mt19937 random(11);
    for (int i = 0; i < 3000; ++i) {
      const int h = static_cast<int>(random() % static_cast<unsigned>(m.halfedge_slots()));
      if (!m.is_face(h / 3)) continue;
      const unsigned what = random() % 5;
      if (what == 0) m.split_edge(h, m.position(m.from(h)) + 0.5 * m.edge_vector(h));
      else if (what < 3 && m.can_flip(h)) m.flip_edge(h);
      else if (what >= 3 && m.can_collapse(h) && (!m.is_boundary_vertex(m.from(h)) || m.opposite(h) < 0)) m.collapse(h);
    }
    const TriangleMesh end = m.compacted().mesh;  // throws if a vertex has several fans
    EXPECT_EQ(end.euler_characteristic(), start.euler_characteristic());
    for (int h = 0; h < end.halfedge_count(); ++h) {
      const int o = end.opposite(h);
      if (o < 0) continue;
      EXPECT_EQ(end.opposite(o), h);
      EXPECT_EQ(end.from(o), end.to(h));
      EXPECT_EQ(end.to(o), end.from(h));
    }
    const TriangleMesh again(end.positions(), end.faces());  // no edge is doubled
    EXPECT_EQ(again.opposites(), end.opposites());
  }
}

/// A cube whose faces are gridded without regard to each other, each with corners of its own.
PolygonSoup unwelded_cube(const std::array<int, 6>& grids) {
  PolygonSoup soup;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3, n = grids[side], first = static_cast<int>(soup.positions.size());
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        Vector3 p;
        p[axis] = side % 2;
        p[u] = static_cast<double>(i) / n;
        p[v] = static_cast<double>(j) / n;
        soup.positions.push_back(p);
      }
    const auto at = [&](int i, int j) { return first + i * (n + 1) + j; };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        std::vector<int> corners{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        if (side % 2 == 0) std::reverse(corners.begin(), corners.end());
        add_face(soup, corners);
      }
  }
  return soup;
}

TEST(MeshBuilder, ClosesCracksOfUnweldedFacesThatAreGriddedDifferently) {
  for (const std::array<int, 6>& grids :
       {std::array{1, 1, 2, 2, 2, 2}, std::array{3, 3, 2, 2, 2, 2}, std::array{1, 2, 3, 4, 5, 6}, std::array{4, 4, 4, 4, 4, 5}}) {
    const BuiltMesh built = build_mesh(unwelded_cube(grids));
    EXPECT_EQ(topology_of(built.mesh), (Topology{1, 2, 0}));
    EXPECT_NEAR(signed_volume(built.mesh), 1, 1e-9);
    EXPECT_TRUE(has_defect(built.defects, "unwelded_vertex"));
    EXPECT_TRUE(has_defect(built.defects, "t_junction"));
    EXPECT_FALSE(has_defect(built.defects, "touching_vertex"));
  }
}

TEST(MeshBuilder, PartsThinAsAHairAreLeftOutOrRefused) {
  PolygonSoup needle;
  needle.positions = {{0, 0, 0}, {1e7, 0, 0}, {5e6, 1, 0}};
  add_face(needle, {0, 1, 2});
  EXPECT_EQ(refusal(needle), "thin_component");
  needle.positions[2][1] = 1e3;
  EXPECT_EQ(refusal(needle), "");
  PolygonSoup both = test::soup_of(test::icosphere(2, 100));
  const int first = static_cast<int>(both.positions.size());
  for (const Vector3& p : {Vector3(200, 0, 0), Vector3(300, 0, 0), Vector3(250, 1e-4, 0)}) both.positions.push_back(p);
  add_face(both, {first, first + 1, first + 2});
  const BuiltMesh built = build_mesh(both);
  EXPECT_EQ(topology_of(built.mesh), (Topology{1, 2, 0}));
  EXPECT_TRUE(has_defect(built.defects, "thin_component"));
}

TEST(MeshBuilder, RefusesCoordinatesThatOverflowOrHaveNoDigits) {
  PolygonSoup soup = test::soup_of(test::icosphere(1));
  for (Vector3& p : soup.positions) p *= 1.5e308;
  EXPECT_EQ(refusal(soup), "coordinates_too_large");
  for (Vector3& p : soup.positions) p *= 1e-8;
  EXPECT_EQ(refusal(soup), "");
  for (const double size : {1e-308, 1e-312, 1e-316, 1e-318, 1e-320}) {
    soup = test::soup_of(test::icosphere(1));
    for (Vector3& p : soup.positions) p *= size;
    EXPECT_EQ(refusal(soup), "coordinates_too_small") << size;
  }
  soup = test::soup_of(test::icosphere(1));
  for (Vector3& p : soup.positions) p *= 1e-307;
  EXPECT_EQ(refusal(soup), "");
}

/// Each is a reason to refuse the mesh, and none hides what else is wrong with it.
TEST(MeshBuilder, CheckLooksAtTheFacesBesideThoseThatItRefuses) {
  PolygonSoup soup = test::soup_of(test::icosphere(2));
  const int faces = static_cast<int>(soup.face_sizes.size());
  flip_face(soup, 100);
  add_face(soup, {soup.face_vertices[60], soup.face_vertices[61], soup.face_vertices[62]});
  add_face(soup, {0, 1, 100000});
  const int nan = static_cast<int>(soup.positions.size());
  soup.positions.push_back(Vector3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  add_face(soup, {0, 1, nan});
  soup.positions.push_back(Vector3(1e30, 0, 0));
  add_face(soup, {0, 1, nan + 1});
  const std::vector<Defect> defects = check_mesh(soup);
  const auto elements = [&](const std::string& code) {
    const auto found = std::find_if(defects.begin(), defects.end(), [&](const Defect& d) { return d.code == code; });
    return found == defects.end() ? std::vector<int>{} : found->elements;
  };
  EXPECT_EQ(elements("flipped_face"), std::vector<int>{100});
  EXPECT_EQ(elements("duplicate_face").size(), 1u);
  EXPECT_EQ(elements("index_out_of_range"), std::vector<int>{faces + 1});
  EXPECT_EQ(elements("non_finite_vertex"), std::vector<int>{nan});
  EXPECT_EQ(elements("coordinate_outlier"), std::vector<int>{nan + 1});
  EXPECT_TRUE(elements("isolated_vertex").empty());
  EXPECT_EQ(defects.back().code, "index_out_of_range") << "what a run is refused for";
  EXPECT_EQ(refusal(soup), "index_out_of_range");
}

TEST(MeshBuilder, CheckLooksBesideASurfaceWithOneSide) {
  constexpr int kAround = 12;
  PolygonSoup soup = test::soup_of(test::icosphere(1));
  const int body_faces = static_cast<int>(soup.face_sizes.size()), a = soup.face_vertices[0], b = soup.face_vertices[1];
  const int tip = static_cast<int>(soup.positions.size());
  soup.positions.push_back(3 * (soup.positions[a] + soup.positions[b]));
  add_face(soup, {a, b, tip});
  const int strip = static_cast<int>(soup.positions.size());
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * 3.14159265358979 * i / kAround;
    for (const double side : {-0.3, 0.3}) {
      const double r = 3 + side * std::cos(angle / 2);
      soup.positions.push_back(Vector3(20 + r * std::cos(angle), r * std::sin(angle), side * std::sin(angle / 2)));
    }
  }
  for (int i = 0; i < kAround; ++i) {
    const bool is_last = i + 1 == kAround;
    const int p = strip + 2 * i, q = is_last ? strip : p + 2;
    add_face(soup, {p, is_last ? q + 1 : q, is_last ? q : q + 1, p + 1});
  }
  const std::vector<Defect> defects = check_mesh(soup);
  const auto found = std::find_if(defects.begin(), defects.end(), [](const Defect& d) { return d.code == "non_manifold_edge"; });
  ASSERT_NE(found, defects.end());
  EXPECT_EQ(found->elements, (std::vector<int>{std::min(a, b), std::max(a, b)}));
  EXPECT_TRUE(has_defect(defects, "non_manifold_vertex")) << "found once the strip is left out";
  EXPECT_EQ(std::count_if(defects.begin(), defects.end(), [](const Defect& d) { return d.code == "non_manifold_edge"; }), 1);
  EXPECT_EQ(defects.back().code, "non_orientable");
  EXPECT_EQ(defects.back().elements.size(), static_cast<std::size_t>(kAround));
  EXPECT_EQ(defects.back().elements.front(), body_faces + 1);
}

TEST(MeshBuilder, ASpikeIsRefusedByItsVertex) {
  PolygonSoup soup = test::soup_of(test::icosphere(2));
  soup.positions[5] = Vector3(1e6, 0, 0);
  EXPECT_EQ(refusal(soup), "coordinate_outlier");
  EXPECT_EQ(check_mesh(soup).back().elements, std::vector<int>{5});
}

TEST(MeshBuilder, AsksWhetherToGoOnAllTheWay) {
  const PolygonSoup soup = test::soup_of(test::torus(600, 300));
  RunContext context;
  int asked = 0;
  context.stop_requested = [&] { return ++asked, false; };
  build_mesh(soup, context);
  EXPECT_GT(asked, 40);
  for (const int last : {1, asked / 3, asked / 2, asked}) {
    int left = last;
    context.stop_requested = [&] { return --left <= 0; };
    EXPECT_THROW(build_mesh(soup, context), Cancelled);
  }
}

TEST(MeshBuilder, DoesNotAskForEachOfManySmallParts) {
  PolygonSoup soup;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 at(3.0 * i, 0, 0);
    const int first = static_cast<int>(soup.positions.size());
    for (const Vector3& corner : {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)}) soup.positions.push_back(at + corner);
    soup.face_sizes.push_back(3);
    for (int k = 0; k < 3; ++k) soup.face_vertices.push_back(first + k);
  }
  RunContext context;
  int asked = 0;
  context.stop_requested = [&] { return ++asked, false; };
  build_mesh(soup, context);
  EXPECT_LT(asked, 100);
}

}  // namespace
}  // namespace hybrid_quad
