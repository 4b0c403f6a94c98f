#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/symmetry/symmetry.h"
#include "support/meshes.h"
#include "support/quad_complexes.h"

namespace hybrid_quad {
namespace {

constexpr PlaneSet kX = plane(0), kY = plane(1), kZ = plane(2);

TriangleMesh transformed(const TriangleMesh& mesh, const Vector3& scale, const Vector3& shift) {
  std::vector<Vector3> positions = mesh.positions();
  for (Vector3& p : positions) p = p.cwiseProduct(scale) + shift;
  return TriangleMesh(std::move(positions), mesh.faces(), mesh.opposites());
}

TriangleMesh centred_box(int n, const Vector3& size) { return transformed(test::box(n, size), {1, 1, 1}, -0.5 * size); }

/// A sphere without any symmetry in its triangles and almost none in its shape.
TriangleMesh uneven_ball() {
  TriangleMesh ball = test::icosphere(3);
  std::vector<Vector3> positions = ball.positions();
  for (Vector3& p : positions) p *= 1 + 0.2 * std::sin(3 * p[0] + 1) * std::cos(2 * p[1] + p[2]);
  return TriangleMesh(std::move(positions), ball.faces(), ball.opposites());
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  std::vector<Vector3> positions = a.positions();
  std::vector<std::array<int, 3>> faces = a.faces();
  positions.insert(positions.end(), b.positions().begin(), b.positions().end());
  for (std::array<int, 3> f : b.faces()) {
    for (int& v : f) v += a.vertex_count();
    faces.push_back(f);
  }
  return TriangleMesh(std::move(positions), std::move(faces));
}

RemeshResult remeshed(const TriangleMesh& mesh, int quads, PlaneSet planes, double sharp_angle = 40, bool detect = false) {
  RemeshOptions options;
  options.quads = quads;
  options.sharp_angle = sharp_angle;
  options.use_sharp_angle = sharp_angle < 180;
  options.symmetry.planes = planes;
  options.symmetry.detect = detect;
  return remesh(test::soup_of(mesh), options, RunContext{});
}


using Key = std::array<double, 3>;
using FaceKey = std::array<Key, 4>;

Key key_of(const Vector3& p) { return {p[0] + 0.0, p[1] + 0.0, p[2] + 0.0}; }  // one zero only

/// The corners' coordinates in the face's direction, from the least on.
FaceKey face_key(const std::array<Vector3, 4>& corners) {
  FaceKey key;
  for (int i = 0; i < 4; ++i) key[i] = key_of(corners[i]);
  std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
  return key;
}

/// Vertices and oriented faces are mapped to each other one to one, with the very same coordinates.
void expect_mirrored(const QuadMesh& mesh, int axis) {
  std::multiset<Key> points, images;
  for (Vector3 p : mesh.positions) {
    points.insert(key_of(p));
    p[axis] = -p[axis];
    images.insert(key_of(p));
  }
  EXPECT_EQ(points, images) << "vertices about axis " << axis;
  std::multiset<FaceKey> faces, face_images;
  for (const auto& q : mesh.quads) {
    std::array<Vector3, 4> forth, back;
    for (int i = 0; i < 4; ++i) {
      forth[i] = back[3 - i] = mesh.positions[q[i]];
      back[3 - i][axis] = -back[3 - i][axis];
    }
    faces.insert(face_key(forth));
    face_images.insert(face_key(back));
  }
  EXPECT_EQ(faces, face_images) << "faces about axis " << axis;
}

/// No quad reaches through the plane, and the edges on it are chains: two at every vertex, one where the border begins.
void expect_seam(const QuadMesh& mesh, int axis, int least_edges) {
  std::map<std::array<int, 2>, int> uses;
  for (const auto& q : mesh.quads) {
    double low = 0, high = 0;
    for (int i = 0; i < 4; ++i) {
      low = std::min(low, mesh.positions[q[i]][axis]);
      high = std::max(high, mesh.positions[q[i]][axis]);
      ++uses[{std::min(q[i], q[(i + 1) & 3]), std::max(q[i], q[(i + 1) & 3])}];
    }
    EXPECT_FALSE(low < 0 && high > 0) << "a quad lies across the plane";
  }
  std::vector<int> degree(mesh.positions.size(), 0), on_border(mesh.positions.size(), 0);
  int edges = 0;
  for (const auto& [edge, count] : uses) {
    if (count == 1) on_border[edge[0]] = on_border[edge[1]] = 1;
    if (mesh.positions[edge[0]][axis] != 0 || mesh.positions[edge[1]][axis] != 0) continue;
    ++edges;
    ++degree[edge[0]];
    ++degree[edge[1]];
  }
  EXPECT_GE(edges, least_edges);
  for (std::size_t v = 0; v < degree.size(); ++v)
    if (mesh.positions[v][axis] == 0) {
      EXPECT_EQ(degree[v], on_border[v] ? 1 : 2) << "vertex " << v;
    }
}

void expect_symmetric_and_sound(const RemeshResult& result, const TriangleMesh& input, PlaneSet planes, int least_edges) {
  EXPECT_TRUE(violations_of(result.mesh).empty()) << violations_of(result.mesh).front();
  EXPECT_EQ(result.report.symmetry.planes, planes);
  EXPECT_EQ(euler_characteristic(result.mesh), input.euler_characteristic());
  for (int axis = 0; axis < 3; ++axis)
    if (has_plane(planes, axis)) {
      expect_mirrored(result.mesh, axis);
      expect_seam(result.mesh, axis, least_edges);
    }
}

TEST(Deviation, IsNoneForASymmetricBoxAndThatOfAShiftOtherwise) {
  const TriangleMesh mesh = transformed(centred_box(6, {1, 2, 3}), {1, 1, 1}, {0, 0.1, 0});
  const auto deviation = plane_deviations(mesh, RunContext{});
  EXPECT_LT(deviation[0].largest, 1e-9);
  EXPECT_LT(deviation[2].largest, 1e-9);
  // A shift by 0.1 puts the ends 0.2 apart.
  EXPECT_NEAR(deviation[1].largest, 100 * 0.2 / mesh.diagonal(), 1e-6);
  EXPECT_GT(deviation[1].mean, 0);
  EXPECT_LT(deviation[1].mean, deviation[1].largest);
}

TEST(Deviation, DoesNotDependOnTheTriangles) {
  // Symmetric as a surface, not as a triangulation.
  const TriangleMesh mesh = centred_box(5, {1, 1, 1});
  for (const PlaneDeviation& deviation : plane_deviations(mesh, RunContext{})) EXPECT_LT(deviation.largest, 1e-9);
}

TEST(PositivePart, KeepsThePositiveHalfExactly) {
  const TriangleMesh ball = uneven_ball();
  for (const PlaneSet planes : {kX, kY, PlaneSet(kX | kZ), PlaneSet(kX | kY | kZ)}) {
    const PositivePart part = positive_part(ball, planes);
    ASSERT_EQ(part.vertex.size(), static_cast<std::size_t>(part.mesh.vertex_count()));
    ASSERT_EQ(part.halfedge.size(), static_cast<std::size_t>(part.mesh.halfedge_count()));
    EXPECT_EQ(part.mesh.euler_characteristic(), 1) << "a disk";
    for (const Vector3& p : part.mesh.positions())
      for (int axis = 0; axis < 3; ++axis)
        if (has_plane(planes, axis)) {
          EXPECT_GE(p[axis], 0);
        }
    for (int h = 0; h < part.mesh.halfedge_count(); ++h)
      EXPECT_EQ(part.mesh.is_boundary(h), planes_of_edge(part.mesh, h, planes) != 0);
  }
}

TEST(PositivePart, TakesDataAlong) {
  const TriangleMesh ball = uneven_ball();
  const PositivePart part = positive_part(ball, kX | kY);
  const double snap = 0.05 * ball.mean_edge_length();
  for (int v = 0; v < part.mesh.vertex_count(); ++v) {
    // Any value on the vertices, the position for one, comes out where it was.
    Vector3 p = Vector3::Zero();
    double sum = 0;
    for (int i = 0; i < 3 && part.vertex[v].vertex[i] >= 0; ++i) {
      p += part.vertex[v].weight[i] * ball.position(part.vertex[v].vertex[i]);
      sum += part.vertex[v].weight[i];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_LT((p - part.mesh.position(v)).norm(), snap);
  }
  for (int h = 0; h < part.mesh.halfedge_count(); ++h) {
    EXPECT_EQ(part.halfedge[h] >= 0, part.halfedge[h] >= 0 && part.halfedge[h] / 3 == part.face[h / 3]);
    if (part.halfedge[h] < 0) continue;
    const Vector3 a = ball.position(ball.from(part.halfedge[h])), along = ball.edge_vector(part.halfedge[h]).normalized();
    for (const int v : {part.mesh.from(h), part.mesh.to(h)}) {
      const Vector3 d = part.mesh.position(v) - a;
      EXPECT_LT((d - d.dot(along) * along).norm(), snap) << "a piece of an edge lies on it";
    }
  }
}

TEST(PositivePart, VerticesNearThePlaneMoveOntoIt) {
  TriangleMesh box = centred_box(4, {1, 1, 1});
  std::vector<Vector3> positions = box.positions();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-1e-3, 1e-3);
  for (Vector3& p : positions)
    if (p[0] == 0) p[0] = noise(random);
  const PositivePart part = positive_part(TriangleMesh(positions, box.faces(), box.opposites()), kX);
  EXPECT_EQ(part.mesh.face_count(), box.face_count() / 2) << "nothing is cut";
}

TEST(PositivePart, AThinPlateKeepsItsMiddle) {
  // A hundredth as thick as it is long: its sides are nearer to the plane than a fiftieth of their edges.
  for (const double thickness : {0.01, 0.003}) {
    const TriangleMesh plate = centred_box(4, {1, 1, thickness});
    for (const PlaneSet planes : {kZ, PlaneSet(kX | kY | kZ)}) {
      const PositivePart part = positive_part(plate, planes);
      EXPECT_EQ(part.mesh.euler_characteristic(), 1);
      EXPECT_EQ(part.faces_in_plane, 0);
      const double images = planes == kZ ? 2 : 8;
      EXPECT_NEAR(images * part.mesh.total_area(), plate.total_area(), 1e-9);
    }
  }
}

TEST(PositivePart, RefusesASurfaceThatThePlaneMisses) {
  const auto code = [](const TriangleMesh& mesh, PlaneSet planes) {
    try {
      positive_part(mesh, planes);
    } catch (const InputError& error) {
      return error.code;
    }
    return std::string();
  };
  const TriangleMesh box = test::box(3);  // [0, 1]^3: a face on each plane
  EXPECT_EQ(code(transformed(box, {1, 1, 1}, {0.5, 0, 0}), kX), "symmetry_plane_missed");
  EXPECT_EQ(code(transformed(box, {1, 1, 1}, {-2, 0, 0}), kX), "symmetry_side_empty");
  // Touches with one vertex only: a ball beside the plane.
  const TriangleMesh ball = test::icosphere(2);
  double least = 0;
  for (const Vector3& p : ball.positions()) least = std::min(least, p[0]);
  EXPECT_EQ(code(transformed(ball, {1, 1, 1}, {-least, 0, 0}), kX), "symmetry_plane_missed");
  EXPECT_EQ(code(test::flat_grid(4, 4), kZ), "symmetry_side_empty") << "lies in the plane";
}

TEST(PositivePart, RefusesAnEdgeInTwoPlanes) {
  const TriangleMesh grid = test::flat_grid(4, 4);
  std::vector<Vector3> positions = grid.positions();
  for (Vector3& p : positions) p.z() = p.y();  // leaves both planes along the x axis
  const TriangleMesh slope(positions, grid.faces());
  for (const PlaneSet one : {plane(1), plane(2)}) EXPECT_EQ(positive_part(slope, one).mesh.face_count(), grid.face_count());
  try {
    positive_part(slope, plane(1) | plane(2));
    FAIL() << "four mirror images share an edge";
  } catch (const InputError& error) {
    EXPECT_EQ(error.code, "symmetry_edge_in_two_planes");
  }
}

TEST(PositivePart, AFaceInThePlaneOpensTheSurface) {
  const TriangleMesh box = test::box(3);
  const PositivePart part = positive_part(box, kX);
  EXPECT_EQ(part.faces_in_plane, 2 * 3 * 3);
  EXPECT_EQ(part.mesh.euler_characteristic(), 1);
}

TEST(Seam, EndsWhereTheBoundaryChangesItsPlane) {
  const PositivePart part = positive_part(uneven_ball(), kX | kY | kZ);
  EXPECT_EQ(seam_ends(part.mesh, kX | kY | kZ).size(), 3u);
  EXPECT_TRUE(seam_ends(positive_part(uneven_ball(), kX).mesh, kX).empty()) << "one closed seam";
  const TriangleMesh grid = transformed(test::flat_grid(7, 5), {1, 1, 1}, {-0.45, 0, 0});
  EXPECT_EQ(seam_ends(positive_part(grid, kX).mesh, kX).size(), 2u);
}

/// A complex whose whole border is one seam.
QuadComplex with_seam_border(QuadComplex complex) {
  for (std::size_t d = 0; d < complex.opposite.size(); ++d) {
    if (complex.opposite[d] >= 0) continue;
    complex.curve[d] = 0;
    for (const int v : {complex.from(static_cast<int>(d)), complex.to(static_cast<int>(d))}) {
      complex.kind[v] = VertexKind::kCurve;
      complex.anchor[v] = 0;
    }
  }
  return complex;
}

/// Whether a part welded to its image along the whole border is an indexed mesh.
std::vector<std::string> violations_when_mirrored(const QuadComplex& complex) {
  QuadMesh mesh = to_quad_mesh(complex);
  for (Vector3& p : mesh.positions) p[2] = 1;
  for (const QuadMesh::FeatureEdge& e : mesh.feature_edges) mesh.positions[e.a][2] = mesh.positions[e.b][2] = 0;
  return violations_of(mirror_quads(mesh, {kZ}, kZ, std::vector<char>(mesh.feature_edges.size(), 0)));
}

TEST(Seam, IsOpenedWhereMirroringWouldFail) {
  for (const auto& [n, m] : {std::pair{1, 1}, {1, 4}, {2, 2}, {1, 2}, {3, 5}}) {
    QuadComplex complex = with_seam_border(test::quad_grid(n, m));
    EXPECT_FALSE(violations_when_mirrored(complex).empty()) << "four corners have one quad";
    EXPECT_GT(open_seams(complex, {kZ}), 0);
    EXPECT_TRUE(violations_of(complex).empty());
    EXPECT_EQ(violations_when_mirrored(complex), std::vector<std::string>()) << n << " x " << m;
    EXPECT_EQ(open_seams(complex, {kZ}), 0);
  }
  QuadComplex strip = with_seam_border(test::quad_tube(6, 1));  // one quad from seam to seam
  EXPECT_FALSE(violations_when_mirrored(strip).empty());
  EXPECT_EQ(open_seams(strip, {kZ}), 1);
  EXPECT_EQ(strip.quad_count(), 12);
  EXPECT_EQ(violations_when_mirrored(strip), std::vector<std::string>());
}

TEST(Seam, StaysAsItIsWhereMirroringIsFine) {
  QuadComplex tube = with_seam_border(test::quad_tube(6, 2));
  EXPECT_EQ(open_seams(tube, {kZ}), 0);
  QuadComplex border = with_seam_border(test::quad_grid(3, 3));
  EXPECT_EQ(open_seams(border, {0}), 0) << "a border that is no seam may have lone quads";
}

TEST(Seam, FreeVerticesKeepClearOfIt) {
  QuadMesh mesh = to_quad_mesh(with_seam_border(test::quad_grid(4, 4)));
  for (Vector3& p : mesh.positions) p[2] = 1;
  for (const QuadMesh::FeatureEdge& e : mesh.feature_edges) mesh.positions[e.a][2] = mesh.positions[e.b][2] = 0;
  const std::vector<Vector3> before = mesh.positions;
  EXPECT_EQ(keep_clear_of_planes(mesh, kZ), 0);
  EXPECT_EQ(mesh.positions, before);
  int touched = 0;
  for (std::size_t v = 0; v < before.size() && touched < 3; ++v)
    if (mesh.kind[v] == VertexKind::kFree) mesh.positions[v][2] = touched++ == 0 ? 0 : -0.5;
  EXPECT_GE(keep_clear_of_planes(mesh, kZ), 3);
  for (std::size_t v = 0; v < before.size(); ++v) {
    if (mesh.kind[v] == VertexKind::kFree) {
      EXPECT_GT(mesh.positions[v][2], 0);
    } else {
      EXPECT_EQ(mesh.positions[v], before[v]);
    }
  }
}

struct Case {
  const char* name;
  TriangleMesh mesh;
  PlaneSet planes;
  int quads;
  double sharp_angle;
  int least_seam;
};

TEST(SymmetricRemesh, GivesExactImagesOfEveryTopology) {
  const TriangleMesh upright = test::torus(24, 12);
  const Case cases[] = {
      {"box", centred_box(5, {1, 1, 1}), kX, 200, 40, 8},
      {"box of two planes", centred_box(5, {1, 2, 1}), kX | kY, 300, 40, 8},
      {"box of three planes", centred_box(5, {1, 2, 3}), kX | kY | kZ, 300, 40, 8},
      {"ellipsoid", transformed(test::icosphere(3), {1, 2, 1.5}, {0, 0, 0}), kX | kY | kZ, 400, 180, 12},
      {"torus through the hole", upright, kX, 300, 180, 12},
      {"torus in its own plane", upright, kZ, 300, 180, 12},
      {"torus of three planes", upright, kX | kY | kZ, 400, 180, 12},
      {"open grid", transformed(test::flat_grid(9, 7), {1, 1, 1}, {-0.5, -0.5, 0}), kX | kY, 100, 180, 4},
      {"open tube", transformed(test::open_cylinder(20, 8), {1, 1, 1}, {0, 0, -1}), kX | kZ, 200, 180, 4},
      {"few quads", test::icosphere(3), kX | kY | kZ, 24, 180, 4},
      {"two boxes, one on each side",
       joined(transformed(centred_box(3, {1, 1, 1}), {1, 1, 1}, {2, 0, 0}), transformed(centred_box(3, {1, 1, 1}), {1, 1, 1}, {-2, 0, 0})),
       kX, 200, 40, 0},
      {"creases across", test::capped_cylinder(24, 6), kX | kY, 300, 40, 8},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const RemeshResult result = remeshed(c.mesh, c.quads, c.planes, c.sharp_angle);
    expect_symmetric_and_sound(result, c.mesh, c.planes, c.least_seam);
    EXPECT_EQ(result.report.quads % (1 << (has_plane(c.planes, 0) + has_plane(c.planes, 1) + has_plane(c.planes, 2))), 0);
  }
}

TEST(SymmetricRemesh, UsesTheAskedPlaneOfAnAsymmetricSurface) {
  const TriangleMesh ball = uneven_ball();
  const RemeshResult result = remeshed(ball, 300, kY, 180);
  expect_symmetric_and_sound(result, ball, kY, 8);
  EXPECT_GT(result.report.symmetry.deviation[1].largest, 1) << "and says how far it is from symmetric";
}

TEST(SymmetricRemesh, MakesAWholeOfAHalf) {
  const PositivePart half = positive_part(uneven_ball(), kX);
  const RemeshResult result = remeshed(half.mesh, 300, kX, 180);
  EXPECT_TRUE(violations_of(result.mesh).empty());
  EXPECT_EQ(euler_characteristic(result.mesh), 2);
  expect_mirrored(result.mesh, 0);
}

/// A square with a needle of its own beyond its side x = 1, so thin that the whole has area enough and the needle has not.
PolygonSoup square_with_needle(double width) {
  PolygonSoup soup = test::soup_of(transformed(test::flat_grid(4, 4), {1, 1, 1}, {-1, 0, 0}));
  const auto at = [&](const Vector3& p) {
    return static_cast<int>(std::find(soup.positions.begin(), soup.positions.end(), p) - soup.positions.begin());
  };
  const int a = at({-0.25, 0, 0}), b = at({0, 0, 0});
  soup.face_sizes.push_back(3);
  for (const int v : {b, a, static_cast<int>(soup.positions.size())}) soup.face_vertices.push_back(v);
  soup.positions.push_back({0.5, -width, 0});
  return soup;
}

TEST(SymmetricRemesh, RefusesANeedleThatIsAllOfTheKeptSide) {
  RemeshOptions options;
  options.quads = 100;
  options.symmetry.planes = kX;
  for (const double width : {1e-7, 1e-9}) {
    PolygonSoup soup = square_with_needle(width);
    for (Vector3& p : soup.positions) p[0] -= 0.1;
    try {
      remesh(soup, options, RunContext{});
      FAIL() << "a needle " << width << " wide";
    } catch (const InputError& error) {
      EXPECT_EQ(error.code, "thin_component");
      EXPECT_EQ(error.elements, std::vector<int>{static_cast<int>(soup.face_sizes.size()) - 1});
    }
  }
}

TEST(SymmetricRemesh, LeavesOutANeedleThatACutTakesFromItsPart) {
  RemeshOptions options;
  options.quads = 100;
  options.symmetry.planes = kX;
  PolygonSoup soup = square_with_needle(1e-6);
  for (Vector3& p : soup.positions) p[0] -= 0.1;
  const TriangleMesh ball = transformed(test::icosphere(2), {1, 1, 1}, {0, 5, 0});
  for (const auto& face : ball.faces()) {
    soup.face_sizes.push_back(3);
    for (const int v : face) soup.face_vertices.push_back(v + static_cast<int>(soup.positions.size()));
  }
  soup.positions.insert(soup.positions.end(), ball.positions().begin(), ball.positions().end());
  const RemeshResult result = remesh(soup, options, RunContext{});
  EXPECT_TRUE(violations_of(result.mesh).empty());
  EXPECT_EQ(euler_characteristic(result.mesh), 2) << "the ball";
  ASSERT_EQ(result.report.defects.size(), 1U);
  EXPECT_EQ(result.report.defects[0].code, "thin_component");
}

TEST(SymmetricRemesh, DetectsPlanes) {
  const TriangleMesh mesh = transformed(centred_box(4, {1, 2, 3}), {1, 1, 1}, {0, 0.3, 0});
  EXPECT_EQ(remeshed(mesh, 200, 0, 40, true).report.symmetry.planes, kX | kZ);
  const RemeshResult none = remeshed(uneven_ball(), 200, 0, 180, true);
  EXPECT_EQ(none.report.symmetry.planes, 0);
  EXPECT_TRUE(none.report.symmetry.is_measured);
  const RemeshResult plain = remeshed(uneven_ball(), 200, 0, 180);
  EXPECT_EQ(none.mesh.positions, plain.mesh.positions) << "nothing found changes nothing";
}

TEST(SymmetricRemesh, DetectsNoPlanesThatLeaveNothing) {
  const TriangleMesh square = transformed(test::flat_grid(6, 6), {1, 1, 1}, {-0.5, -0.5, 0});
  EXPECT_EQ(remeshed(square, 100, 0, 40, true).report.symmetry.planes, kX | kY) << "it lies in the third";
  // What x = 0 leaves of two crossing squares lies in y = 0.
  std::vector<Vector3> upright, crossing;
  for (const Vector3& p : square.positions()) {
    upright.push_back({0, p[0], p[1]});
    crossing.push_back({p[0], 0, p[1]});
  }
  const TriangleMesh cross = joined(TriangleMesh(upright, square.faces()), TriangleMesh(crossing, square.faces()));
  EXPECT_EQ(remeshed(cross, 100, 0, 40, true).report.symmetry.planes, kX | kZ);
}

TEST(SymmetricRemesh, TellsOfAPieceThatIsLost) {
  // A flat ring around a ball, in the mirror plane: without it, the Euler characteristics sum up to the same.
  const TriangleMesh ball = test::icosphere(2);
  const TriangleMesh tube = test::open_cylinder(24, 2);
  std::vector<Vector3> ring = tube.positions();
  double low = HUGE_VAL;
  for (const Vector3& p : ring) low = std::min(low, p[2]);
  for (Vector3& p : ring) p = (2 + p[2] - low) * Vector3(p[0], p[1], 0).normalized();
  const TriangleMesh both = joined(ball, TriangleMesh(ring, tube.faces()));
  const auto tells = [](const RemeshResult& result) {
    const std::vector<std::string>& warnings = result.report.warnings;
    return std::find(warnings.begin(), warnings.end(), "the mirrored surface has another topology than the input") != warnings.end();
  };
  EXPECT_TRUE(tells(remeshed(both, 200, kZ)));
  EXPECT_FALSE(tells(remeshed(both, 200, kX)));
}

TEST(SymmetricRemesh, KeepsMarkedEdgesAndForgetsSmoothSeams) {
  // The outer circle of a torus is marked; the plane x = 0 crosses it, the plane z = 0 contains it.
  const TriangleMesh ring = test::torus(24, 12);
  RemeshOptions options;
  options.quads = 300;
  options.use_sharp_angle = false;
  for (int h = 0; h < ring.halfedge_count(); ++h) {
    const Vector3 a = ring.position(ring.from(h)), b = ring.position(ring.to(h));
    if (std::abs(a[2]) < 1e-9 && std::abs(b[2]) < 1e-9 && std::hypot(a[0], a[1]) > 1 && std::hypot(b[0], b[1]) > 1 && h < ring.opposite(h))
      options.marked_edges.push_back({ring.from(h), ring.to(h)});
  }
  ASSERT_EQ(options.marked_edges.size(), 24u);
  for (const PlaneSet planes : {kX, kZ, PlaneSet(kX | kZ)}) {
    options.symmetry.planes = planes;
    const RemeshResult result = remesh(test::soup_of(ring), options, RunContext{});
    expect_symmetric_and_sound(result, ring, planes, 12);
    double length = 0;
    for (const QuadMesh::FeatureEdge& e : result.mesh.feature_edges) {
      const Vector3 a = result.mesh.positions[e.a], b = result.mesh.positions[e.b];
      EXPECT_NEAR(0.5 * (a + b)[2], 0, 1e-9);
      EXPECT_GT(std::hypot(a[0], a[1]), 1) << "only the marked circle is a feature";
      length += (b - a).norm();
    }
    EXPECT_NEAR(length, 2 * 3.14159 * 1.4, 0.3);
  }
}

TEST(SymmetricRemesh, IsTheSameForAnyNumberOfThreads) {
  RemeshOptions options;
  options.quads = 300;
  options.symmetry.planes = kX;
  RunContext one, three;
  three.threads = 3;
  const PolygonSoup soup = test::soup_of(uneven_ball());
  const RemeshResult a = remesh(soup, options, one), b = remesh(soup, options, three);
  EXPECT_EQ(a.mesh.positions, b.mesh.positions);
  EXPECT_EQ(a.mesh.quads, b.mesh.quads);
}

}  // namespace
}  // namespace hybrid_quad
