#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "hybrid_quad/improve/convex_patch.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/requadrangulate.h"
#include "hybrid_quad/mesh/surface_walk.h"
#include "hybrid_quad/improve/valence_moves.h"
#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/mesh/segment_index.h"
#include "support/meshes.h"
#include "support/quad_moves.h"

namespace hybrid_quad {
namespace {

/// An input with everything that improve_quads needs to know of it.
struct Surface {
  explicit Surface(TriangleMesh m, double sharp_angle = 40) : mesh(std::move(m)) {
    FeatureOptions options;
    options.sharp_angle = sharp_angle;
    features = detect_features(mesh, options, RunContext{});
    index = std::make_unique<SurfaceIndex>(mesh, features.face_region);
  }
  TriangleMesh mesh;
  FeatureGraph features;
  std::unique_ptr<SurfaceIndex> index;
};

/// n x m quads over [0, width] x [0, height], z = 0.
QuadMesh sheet(int n, int m, double width = 1, double height = 1) {
  QuadMesh mesh;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) mesh.positions.emplace_back(width * i / n, height * j / m, 0);
  const auto id = [n](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) mesh.quads.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
  return mesh;
}

/// n x n quads on every side of the unit cube.
QuadMesh cube(int n) {
  QuadMesh mesh;
  std::map<std::array<int, 3>, int> ids;
  const auto id = [&](const std::array<int, 3>& at) {
    const auto [place, is_new] = ids.try_emplace(at, static_cast<int>(mesh.positions.size()));
    if (is_new) mesh.positions.emplace_back(at[0] / double(n), at[1] / double(n), at[2] / double(n));
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int a, int b) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[(axis + 1) % 3] = a;
            at[(axis + 2) % 3] = b;
            return id(at);
          };
          std::array<int, 4> q = {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
          if (side == 0) std::swap(q[1], q[3]);
          mesh.quads.push_back(q);
        }
  return mesh;
}

QuadMesh sphere(int n) {
  QuadMesh mesh = cube(n);
  for (Vector3& p : mesh.positions) p = (p - Vector3(0.5, 0.5, 0.5)).normalized();
  return mesh;
}

/// n quads around and m along the cylinder about the z axis.
QuadMesh tube(int n, int m, double radius = 1, double height = 2) {
  QuadMesh mesh;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < n; ++i)
      mesh.positions.emplace_back(radius * std::cos(2 * M_PI * i / n), radius * std::sin(2 * M_PI * i / n), height * j / m);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) mesh.quads.push_back({j * n + i, j * n + (i + 1) % n, (j + 1) * n + (i + 1) % n, (j + 1) * n + i});
  return mesh;
}

/// Kinds, anchors and feature edges of quads whose feature vertices lie on the input's curves.
void bind(QuadMesh& quads, const Surface& surface) {
  const double near = 0.02 * surface.mesh.diagonal();
  const int n = static_cast<int>(quads.positions.size());
  std::vector<std::array<Vector3, 2>> segments;
  std::vector<std::array<int, 2>> owner;
  for (int c = 0; c < static_cast<int>(surface.features.curves.size()); ++c) {
    const auto& v = surface.features.curves[c].vertices;
    for (int i = 0; i + 1 < static_cast<int>(v.size()); ++i) {
      segments.push_back({surface.mesh.position(v[i]), surface.mesh.position(v[i + 1])});
      owner.push_back({c, i});
    }
  }
  const SegmentIndex index(std::move(segments));
  quads.kind.assign(n, VertexKind::kFree);
  quads.anchor.assign(n, 0);
  quads.near_face.assign(n, -1);
  std::vector<double> place(n, 0);
  for (int v = 0; v < n; ++v) {
    const SegmentPoint point = index.nearest(quads.positions[v]);
    if (point.segment >= 0 && point.squared_distance < near * near * 1e-6) {
      quads.kind[v] = VertexKind::kCurve;
      quads.anchor[v] = owner[point.segment][0];
      place[v] = owner[point.segment][1] + point.fraction;
    } else {
      quads.anchor[v] = surface.features.face_region[surface.index->nearest(quads.positions[v]).face];
    }
    for (int w = 0; w < surface.mesh.vertex_count(); ++w)
      if (surface.features.is_corner[w] && (surface.mesh.position(w) - quads.positions[v]).norm() < 1e-3 * near) {
        quads.kind[v] = VertexKind::kCorner;
        quads.anchor[v] = w;
      }
  }
  quads.feature_edges.clear();
  const auto is_end = [&](int v, int c) {
    const auto& along = surface.features.curves[c].vertices;
    return quads.kind[v] == VertexKind::kCorner && (along.front() == quads.anchor[v] || along.back() == quads.anchor[v]);
  };
  const auto add = [&](int a, int b, int c) {
    const auto& along = surface.features.curves[c].vertices;
    const double last = static_cast<double>(along.size()) - 1;
    const auto position = [&](int v, double other) {
      if (quads.kind[v] == VertexKind::kCurve) return place[v];
      if (along.front() == along.back()) return other < last / 2 ? 0.0 : last;
      return along.front() == quads.anchor[v] ? 0.0 : last;
    };
    double step = position(b, position(a, 0)) - position(a, position(b, 0));
    if (surface.features.curves[c].closed && std::abs(step) > last / 2) step = -step;
    if (step > 0) quads.feature_edges.push_back({a, b, c});
    else quads.feature_edges.push_back({b, a, c});
  };
  for (const auto& q : quads.quads)
    for (int i = 0; i < 4; ++i) {
      const int a = q[i], b = q[(i + 1) % 4];
      if (quads.kind[a] == VertexKind::kFree || quads.kind[b] == VertexKind::kFree) continue;
      const SegmentPoint middle = index.nearest(0.5 * (quads.positions[a] + quads.positions[b]));
      if (std::sqrt(middle.squared_distance) > near) continue;
      const int c = owner[middle.segment][0];
      const auto on = [&](int v) { return quads.kind[v] == VertexKind::kCurve ? quads.anchor[v] == c : is_end(v, c); };
      if (!on(a) || !on(b)) continue;
      const bool known = std::any_of(quads.feature_edges.begin(), quads.feature_edges.end(), [&](const auto& e) {
        return (e.a == a && e.b == b) || (e.a == b && e.b == a);
      });
      if (!known) add(a, b, c);
    }
}

/// Free vertices shaken by up to `amount`, curve vertices along their edges.
void shake(QuadMesh& quads, double amount, unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&] { return 2.0 * random() / 4294967295.0 - 1.0; };
  for (std::size_t v = 0; v < quads.positions.size(); ++v) {
    const Vector3 offset(number(), number(), number());
    if (quads.kind[v] == VertexKind::kFree) quads.positions[v] += amount * offset;
  }
  for (const auto& e : quads.feature_edges)
    if (quads.kind[e.a] == VertexKind::kCurve) quads.positions[e.a] += 0.3 * number() * (quads.positions[e.b] - quads.positions[e.a]);
}

ImproveReport improve(QuadMesh& quads, const Surface& surface, const ImproveOptions& options = {}, int threads = 1) {
  RunContext context;
  context.threads = threads;
  return improve_quads(quads, surface.mesh, surface.features, *surface.index, options, context);
}

double distance_to_curve(const Surface& surface, int curve, const Vector3& p) {
  const auto& v = surface.features.curves[curve].vertices;
  std::vector<std::array<Vector3, 2>> segments;
  for (std::size_t i = 0; i + 1 < v.size(); ++i) segments.push_back({surface.mesh.position(v[i]), surface.mesh.position(v[i + 1])});
  return std::sqrt(SegmentIndex(std::move(segments)).nearest(p).squared_distance);
}

void expect_on_features(const QuadMesh& quads, const Surface& surface) {
  const double tolerance = 1e-9 * surface.mesh.diagonal();
  for (std::size_t v = 0; v < quads.positions.size(); ++v)
    if (quads.kind[v] == VertexKind::kCurve) {
      EXPECT_LE(distance_to_curve(surface, quads.anchor[v], quads.positions[v]), tolerance);
    } else if (quads.kind[v] == VertexKind::kCorner) {
      EXPECT_EQ(quads.positions[v], surface.mesh.position(quads.anchor[v]));
    }
}

TEST(Improve, ShakenBoxBecomesGoodAndKeepsItsFeatures) {
  const Surface surface(test::box(6));
  QuadMesh quads = cube(7);
  bind(quads, surface);
  ASSERT_EQ(std::count(quads.kind.begin(), quads.kind.end(), VertexKind::kCorner), 8);
  ASSERT_EQ(quads.feature_edges.size(), 84u);
  const std::size_t edges = quads.feature_edges.size();
  shake(quads, 0.05, 1);
  const ShapeQuality before = shape_quality(quads);
  improve(quads, surface);
  const ShapeQuality after = shape_quality(quads);
  EXPECT_GT(after.scaled_jacobian_mean, before.scaled_jacobian_mean);
  EXPECT_GT(after.scaled_jacobian_min, 0.9);
  EXPECT_TRUE(violations_of(quads).empty());
  EXPECT_EQ(quads.feature_edges.size(), edges);
  expect_on_features(quads, surface);
  EXPECT_LT(surface_distance(quads, *surface.index, RunContext{}).hausdorff(), 0.5);
}

TEST(Improve, FeatureEdgesStayMeshEdges) {
  const Surface surface(test::box(5));
  QuadMesh quads = cube(6);
  bind(quads, surface);
  shake(quads, 0.06, 5);
  improve(quads, surface);
  const EditMesh mesh(quads, surface.mesh, surface.features);
  for (const auto& e : quads.feature_edges) EXPECT_TRUE(mesh.has_edge(e.a, e.b));
}

TEST(Improve, UntanglesAFoldedGrid) {
  const Surface surface(test::flat_grid(9, 9));
  QuadMesh quads = sheet(10, 10);
  bind(quads, surface);
  const auto id = [](int i, int j) { return j * 11 + i; };
  quads.positions[id(4, 4)] += Vector3(0.28, 0.05, 0);
  quads.positions[id(5, 5)] -= Vector3(0.31, 0.02, 0);
  quads.positions[id(7, 3)] += Vector3(0.0, 0.25, 0);
  EXPECT_GT(shape_quality(quads).below_zero, 0);
  const ImproveReport report = improve(quads, surface);
  EXPECT_EQ(report.inverted_after, 0);
  EXPECT_GT(shape_quality(quads).scaled_jacobian_min, 0.9);
  for (std::size_t q = 0; q < quads.quads.size(); ++q) {
    const auto& v = quads.quads[q];
    EXPECT_GT((quads.positions[v[2]] - quads.positions[v[0]]).cross(quads.positions[v[3]] - quads.positions[v[1]]).z(), 0);
  }
}

/// Turns random edges of a valid mesh, keeping it valid.
void scramble(QuadMesh& quads, const Surface& surface, int turns, unsigned seed) {
  std::mt19937 random(seed);
  for (int t = 0; t < turns; ++t) {
    const EditMesh mesh(quads, surface.mesh, surface.features);
    const int q = static_cast<int>(random() % quads.quads.size()), side = static_cast<int>(random() % 4);
    const int other = mesh.across(q, side);
    if (other < 0) continue;
    const auto f = quads.quads[q], g = quads.quads[other];
    const int k = mesh.corner_of(other, f[(side + 1) % 4]);
    const int a = f[(side + 3) % 4], b = f[side], x = g[(k + 2) % 4], y = g[(k + 3) % 4], c = f[(side + 1) % 4], d = f[(side + 2) % 4];
    if (mesh.is_feature(b, c) || a == y || mesh.has_edge(a, y)) continue;
    QuadMesh changed = quads;
    changed.quads[q] = {a, b, x, y};
    changed.quads[other] = {a, y, c, d};
    if (violations_of(changed).empty()) quads = changed;
  }
}

TEST(Improve, ScrambledConnectivityGetsMoreRegularAndStaysValid) {
  const Surface ball(test::icosphere(4));
  const Surface box(test::box(6));
  for (const Surface* surface : {&ball, &box})
    for (unsigned seed = 1; seed <= 4; ++seed) {
      QuadMesh quads = surface == &ball ? sphere(8) : cube(8);
      bind(quads, *surface);
      scramble(quads, *surface, 25, seed);
      ASSERT_TRUE(violations_of(quads).empty());
      const ShapeQuality before = shape_quality(quads);
      const std::size_t edges = quads.feature_edges.size();
      improve(quads, *surface);
      const ShapeQuality after = shape_quality(quads);
      EXPECT_TRUE(violations_of(quads).empty());
      EXPECT_LT(after.irregular_vertices, before.irregular_vertices);
      EXPECT_GE(after.scaled_jacobian_mean, before.scaled_jacobian_mean);
      EXPECT_GT(after.scaled_jacobian_min, 0);
      EXPECT_EQ(quads.feature_edges.size(), edges);
      expect_on_features(quads, *surface);
    }
}

TEST(Improve, NoQuadStaysStraightAtAFeature) {
  // The boundary vertex in the middle of a side gets a single quad whose corner there is straight.
  const Surface surface(test::flat_grid(6, 6));
  QuadMesh quads = sheet(6, 6);
  const auto id = [](int i, int j) { return j * 7 + i; };
  // Quads (2,0) and (3,0) over vertex (3,0): turning their common edge leaves one quad at it.
  const int q = 2, r = 3;
  quads.quads[q] = {id(2, 0), id(3, 0), id(4, 0), id(2, 1)};
  quads.quads[r] = {id(2, 1), id(4, 0), id(4, 1), id(3, 1)};
  bind(quads, surface);
  ASSERT_TRUE(violations_of(quads).empty());
  const auto straight = [&] {
    const EditMesh mesh(quads, surface.mesh, surface.features);
    int count = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) count += has_straight_corner(mesh, v);
    return count;
  };
  ASSERT_GT(straight(), 0);
  improve(quads, surface);
  EXPECT_EQ(straight(), 0);
  EXPECT_GT(shape_quality(quads).scaled_jacobian_min, 0.3);
  EXPECT_TRUE(violations_of(quads).empty());
}

/// A triangle with n sides of small triangles along each of its sides.
TriangleMesh triangle(int n) {
  std::vector<Vector3> positions;
  std::vector<std::array<int, 3>> faces;
  const auto id = [n](int i, int j) { return j * (n + 1) - j * (j - 1) / 2 + i; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i + j <= n; ++i) positions.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n, 0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i + j < n; ++i) {
      faces.push_back({id(i, j), id(i + 1, j), id(i, j + 1)});
      if (i + j + 1 < n) faces.push_back({id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return TriangleMesh(positions, faces);
}

TEST(Improve, OneQuadOnATriangleGetsInnerVertices) {
  const Surface surface(triangle(6));
  QuadMesh quads;
  quads.positions = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  quads.quads = {{0, 1, 2, 3}};
  bind(quads, surface);
  ASSERT_EQ(quads.feature_edges.size(), 4u);
  ASSERT_NEAR(shape_quality(quads).scaled_jacobian_min, 0, 1e-12);
  improve(quads, surface);
  EXPECT_TRUE(violations_of(quads).empty());
  EXPECT_GT(shape_quality(quads).scaled_jacobian_min, 0.1);
  expect_on_features(quads, surface);
}

/// Two triangles beside each other, folded along their common side, each filled by one quad that is straight in the middle of another
/// side: opening one leaves the other, and so the worst around, as bad as before.
TEST(Improve, StraightQuadsSideBySideGetInnerVertices) {
  const TriangleMesh half = triangle(6);
  std::vector<Vector3> positions = half.positions();
  std::vector<std::array<int, 3>> faces = half.faces();
  std::vector<int> mirrored(positions.size());
  for (int v = 0; v < half.vertex_count(); ++v) {
    const Vector3 p = half.position(v);
    mirrored[v] = p.x() == 0 ? v : static_cast<int>(positions.size());
    if (p.x() > 0) positions.emplace_back(-p.x(), p.y(), p.x());
  }
  for (const auto& f : half.faces()) faces.push_back({mirrored[f[0]], mirrored[f[2]], mirrored[f[1]]});
  const Surface surface(TriangleMesh(positions, faces), 20);
  QuadMesh quads;
  quads.positions = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.5, 0, 0.5}, {-1, 0, 1}};
  quads.quads = {{0, 1, 2, 3}, {0, 3, 5, 4}};
  bind(quads, surface);
  ASSERT_EQ(quads.feature_edges.size(), 7u);
  ASSERT_TRUE(violations_of(quads).empty());
  ASSERT_NEAR(shape_quality(quads).scaled_jacobian_min, 0, 1e-12);
  improve(quads, surface);
  EXPECT_TRUE(violations_of(quads).empty());
  EXPECT_GT(shape_quality(quads).scaled_jacobian_min, 0.1);
  expect_on_features(quads, surface);
}

TEST(Improve, CrowdedQuadsGo) {
  // One square of the grid holds a web of quads as small as a hundredth of it.
  const Surface surface(test::flat_grid(8, 8));
  QuadMesh quads = sheet(8, 8);
  std::array<int, 4> outer = quads.quads[27];
  quads.quads.erase(quads.quads.begin() + 27);
  for (int ring = 0; ring < 5; ++ring) {
    const Vector3 centre(0.42, 0.41, 0);
    std::array<int, 4> inner;
    for (int i = 0; i < 4; ++i) {
      inner[i] = static_cast<int>(quads.positions.size());
      quads.positions.push_back(centre + 0.2 * (quads.positions[outer[i]] - centre));
    }
    for (int i = 0; i < 4; ++i) quads.quads.push_back({outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i]});
    outer = inner;
  }
  quads.quads.push_back(outer);
  bind(quads, surface);
  ASSERT_TRUE(violations_of(quads).empty());
  ImproveOptions options;
  options.target_length = 1.0 / 8;
  improve(quads, surface, options);
  EXPECT_TRUE(violations_of(quads).empty());
  EXPECT_LE(quads.quads.size(), 70u);
  EXPECT_GT(shape_quality(quads).scaled_jacobian_min, 0.4);
}

TEST(Improve, SameAtAnyScaleAndPlace) {
  const TriangleMesh unit = test::box(6);
  QuadMesh shaken = cube(7);
  {
    const Surface surface(unit);
    bind(shaken, surface);
    shake(shaken, 0.04, 3);
  }
  QuadMesh reference = shaken;
  improve(reference, Surface(unit));
  for (const double scale : {1e-6, 1e6})
    for (const Vector3& offset : {Vector3(0, 0, 0), Vector3(300, -200, 100)}) {
      const auto map = [&](const Vector3& p) { return Vector3(scale * (p + offset)); };
      std::vector<Vector3> positions;
      for (const Vector3& p : unit.positions()) positions.push_back(map(p));
      const Surface surface(TriangleMesh(positions, unit.faces()));
      QuadMesh quads = shaken;
      for (Vector3& p : quads.positions) p = map(p);
      improve(quads, surface);
      ASSERT_EQ(quads.quads, reference.quads);
      for (std::size_t v = 0; v < quads.positions.size(); ++v)
        EXPECT_NEAR((quads.positions[v] - map(reference.positions[v])).norm() / scale, 0, 1e-6);
    }
}

TEST(Improve, SameForAnyNumberOfThreads) {
  const Surface surface(test::icosphere(4));
  QuadMesh start = sphere(12);
  bind(start, surface);
  scramble(start, surface, 20, 9);
  shake(start, 0.02, 2);
  QuadMesh one = start;
  improve(one, surface);
  for (const int threads : {2, 4}) {
    QuadMesh many = start;
    improve(many, surface, {}, threads);
    ASSERT_EQ(many.quads, one.quads);
    for (std::size_t v = 0; v < one.positions.size(); ++v) EXPECT_EQ(many.positions[v], one.positions[v]);
  }
}

TEST(Improve, FitLowersTheDistance) {
  const Surface surface(test::icosphere(5));
  QuadMesh quads = sphere(6);
  bind(quads, surface);
  QuadMesh fitted = quads;
  ImproveOptions options;
  options.fit = false;
  improve(quads, surface, options);
  improve(fitted, surface);
  EXPECT_LT(surface_distance(fitted, *surface.index, RunContext{}).mean,
            0.7 * surface_distance(quads, *surface.index, RunContext{}).mean);
}

TEST(Improve, AreasComeNearTheAskedOnes) {
  const Surface surface(test::icosphere(4));
  QuadMesh start = sphere(12);
  bind(start, surface);
  const auto asked_at = [](const Vector3& p) { return 0.1 * (1 + 0.25 * p.z() / p.norm()); };
  std::vector<double> asked;
  for (const Vector3& p : surface.mesh.positions()) asked.push_back(asked_at(p));
  const auto spread = [&](const QuadMesh& quads) {  // of the logarithms of areas over asked areas
    double sum = 0, squares = 0;
    for (const auto& q : quads.quads) {
      const auto& p = quads.positions;
      const double area = 0.5 * (p[q[2]] - p[q[0]]).cross(p[q[3]] - p[q[1]]).norm();
      const double ratio = std::log(area / std::pow(asked_at(0.25 * (p[q[0]] + p[q[1]] + p[q[2]] + p[q[3]])), 2));
      sum += ratio;
      squares += ratio * ratio;
    }
    const double n = static_cast<double>(quads.quads.size());
    return std::sqrt(squares / n - sum * sum / (n * n));
  };
  ImproveOptions options;
  QuadMesh even = start, sized = start;
  improve(even, surface, options);
  options.asked_lengths = &asked;
  options.area_weight = 1.5;
  improve(sized, surface, options);
  EXPECT_TRUE(violations_of(sized).empty());
  EXPECT_GT(shape_quality(sized).scaled_jacobian_min, 0.5);
  EXPECT_LT(spread(sized), 0.6 * spread(even));
}

TEST(Improve, ThinStripKeepsItsTwoSides) {
  // Curves that run close to each other: one row of quads, its border vertices far out of place.
  const Surface surface(test::flat_grid(60, 2, 1, 0.02));
  QuadMesh quads = sheet(30, 1, 1, 0.02);
  bind(quads, surface);
  shake(quads, 0, 4);
  improve(quads, surface);
  EXPECT_TRUE(violations_of(quads).empty());
  EXPECT_GT(shape_quality(quads).scaled_jacobian_min, 0.5);
  expect_on_features(quads, surface);
}

TEST(Improve, QuadsCrossAThinStripStraight) {
  // Each curve alone is evenly divided already; what is left to better is how the two divisions face each other.
  const int n = 12;
  const double height = 0.02;
  const Surface surface(test::open_cylinder(120, 2, 1, height));
  QuadMesh quads = tube(n, 1, 1, height);
  for (int v = n; v < 2 * n; ++v) quads.positions[v] = Eigen::AngleAxisd(2 * 2 * M_PI / 120, Vector3::UnitZ()) * quads.positions[v];
  bind(quads, surface);
  const double before = shape_quality(quads).scaled_jacobian_mean;
  ASSERT_LT(before, 0.75);
  ImproveOptions options;
  options.edit_connectivity = false;
  improve(quads, surface, options);
  EXPECT_GT(shape_quality(quads).scaled_jacobian_mean, 0.95);
  expect_on_features(quads, surface);
}

TEST(Improve, ClosedCurves) {
  const Surface surface(test::open_cylinder(40, 12));
  QuadMesh quads = tube(20, 6);
  bind(quads, surface);
  ASSERT_EQ(quads.feature_edges.size(), 40u);
  shake(quads, 0.05, 7);
  improve(quads, surface);
  EXPECT_TRUE(violations_of(quads).empty());
  EXPECT_GT(shape_quality(quads).scaled_jacobian_min, 0.9);
  expect_on_features(quads, surface);
}

TEST(Improve, ChordsOfACoarseRingAreNearerThanEvenOnes) {
  // Twelve edges around seventeen sides: where all are as long, some cut a corner in the middle.
  const Surface surface(test::open_cylinder(17, 12));
  QuadMesh quads = tube(12, 4);
  for (Vector3& p : quads.positions) p = surface.index->nearest(p).position;
  bind(quads, surface);
  ASSERT_EQ(quads.feature_edges.size(), 24u);
  improve(quads, surface);
  EXPECT_TRUE(violations_of(quads).empty());
  EXPECT_GT(shape_quality(quads).scaled_jacobian_min, 0.85);
  expect_on_features(quads, surface);
  for (int c = 0; c < 2; ++c) {
    std::vector<Vector3> points;
    for (const int v : surface.features.curves[c].vertices) points.push_back(surface.mesh.position(v));
    const CurveGeometry curve(points, true);
    std::vector<std::array<Vector3, 2>> edges, even;
    for (const auto& e : quads.feature_edges)
      if (e.curve == c) edges.push_back({quads.positions[e.a], quads.positions[e.b]});
    for (int i = 0; i < 12; ++i) even.push_back({curve.at(curve.length() * i / 12), curve.at(curve.length() * (i + 1) / 12)});
    const auto farthest = [&](std::vector<std::array<Vector3, 2>> segments) {
      const SegmentIndex index(std::move(segments));
      double most = 0;
      for (const Vector3& p : points) most = std::max(most, index.nearest(p).squared_distance);
      return std::sqrt(most);
    };
    EXPECT_LT(farthest(edges), 0.95 * farthest(even));
  }
}

TEST(Improve, NothingBadFromDegenerateInput) {
  const Surface surface(test::box(3));
  QuadMesh empty;
  EXPECT_NO_THROW(improve(empty, surface));
  QuadMesh point = cube(3);
  bind(point, surface);
  for (Vector3& p : point.positions) p = Vector3(0.5, 0.5, 1);
  improve(point, surface);
  for (const Vector3& p : point.positions) EXPECT_TRUE(p.allFinite());
  QuadMesh spiky = cube(4);
  bind(spiky, surface);
  for (std::size_t v = 0; v < spiky.positions.size(); v += 3) spiky.positions[v] = 50 * Vector3(1, -1, 0.3);
  improve(spiky, surface);
  EXPECT_TRUE(violations_of(spiky).empty());
  expect_on_features(spiky, surface);
}

int irregular_inside(const QuadMesh& mesh) {
  std::vector<int> valence(mesh.positions.size(), 0);
  for (const auto& q : mesh.quads)
    for (const int v : q) ++valence[v];
  int count = 0;
  for (std::size_t v = 0; v < valence.size(); ++v) count += mesh.kind[v] == VertexKind::kFree && valence[v] != 4;
  return count;
}

/// A sheet with a quad inside a quad, that is, four vertices of three quads and four of five.
QuadMesh pillowed_sheet(const Surface& surface, int n) {
  QuadMesh quads = sheet(n, n);
  const std::array<int, 4> outer = quads.quads[(n / 2) * n + n / 2];
  Vector3 centre = Vector3::Zero();
  for (const int v : outer) centre += 0.25 * quads.positions[v];
  std::array<int, 4> inner;
  for (int i = 0; i < 4; ++i) {
    inner[i] = static_cast<int>(quads.positions.size());
    quads.positions.push_back(0.5 * (centre + quads.positions[outer[i]]));
  }
  quads.quads[(n / 2) * n + n / 2] = inner;
  for (int i = 0; i < 4; ++i) quads.quads.push_back({outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i]});
  bind(quads, surface);
  return quads;
}

TEST(Requadrangulate, TakesAwayIrregularVerticesThatNothingCallsFor) {
  const Surface surface(test::flat_grid(10, 10));
  const QuadMesh quads = pillowed_sheet(surface, 8);
  ASSERT_EQ(irregular_inside(quads), 8);
  Workpiece piece(quads, surface.mesh, surface.features, *surface.index);
  piece.bind_all();
  Smoother smoother(piece, {});
  EXPECT_EQ(requadrangulate_patches(piece, smoother, RunContext{}), 1);
  const QuadMesh filled = piece.mesh.extract();
  EXPECT_EQ(irregular_inside(filled), 0);
  EXPECT_EQ(filled.quads.size(), 64u);
  EXPECT_GT(shape_quality(filled).scaled_jacobian_min, 0.9);
  EXPECT_EQ(filled.feature_edges.size(), quads.feature_edges.size());
  expect_on_features(filled, surface);
}

TEST(Requadrangulate, LeavesLockedQuadsAlone) {
  const Surface surface(test::flat_grid(10, 10));
  const QuadMesh quads = pillowed_sheet(surface, 8);
  Workpiece piece(quads, surface.mesh, surface.features, *surface.index);
  piece.mesh.lock(4 * 8 + 4);
  piece.bind_all();
  Smoother smoother(piece, {});
  EXPECT_EQ(requadrangulate_patches(piece, smoother, RunContext{}), 0);
  EXPECT_EQ(piece.mesh.extract().quads, quads.quads);
}

TEST(Requadrangulate, FillsForAnyMeasure) {
  const Surface surface(test::flat_grid(10, 10));
  const QuadMesh quads = pillowed_sheet(surface, 8);
  Workpiece piece(quads, surface.mesh, surface.features, *surface.index);
  piece.bind_all();
  Smoother smoother(piece, {});
  const int v = quads.quads[4 * 8 + 4][0];
  const auto none_is_better = [](const std::vector<int>&) { return 0.0; };
  EXPECT_FALSE(requadrangulate_around(piece, smoother, v, none_is_better, 0.5));
  EXPECT_EQ(piece.mesh.extract().quads, quads.quads);
  const auto fewer = [](const std::vector<int>& around) { return -static_cast<double>(around.size()); };
  EXPECT_TRUE(requadrangulate_around(piece, smoother, v, fewer, 0.5));
  EXPECT_LT(piece.mesh.extract().quads.size(), quads.quads.size());
}

TEST(ConvexPatch, StopsAtFeaturesAndClosesNotches) {
  const Surface surface(test::flat_grid(10, 10));
  QuadMesh quads = sheet(6, 6);
  bind(quads, surface);
  const EditMesh mesh(quads, surface.mesh, surface.features);
  PatchGrower grower(mesh, 36);
  ASSERT_TRUE(grower.start(1 * 7 + 1));
  while (grower.grow()) {
  }
  EXPECT_FALSE(grower.patch()) << "two irregular vertices are the least that can be better";
  const QuadMesh pillowed = pillowed_sheet(surface, 6);
  const EditMesh other(pillowed, surface.mesh, surface.features);
  PatchGrower around(other, 64);
  ASSERT_TRUE(around.start(pillowed.quads[3 * 6 + 3][0]));
  const auto patch = around.patch();
  ASSERT_TRUE(patch);
  const std::size_t sides = patch->sides.size();
  for (std::size_t i = 0; i < sides; ++i) EXPECT_EQ(patch->sides[i].back(), patch->sides[(i + 1) % sides].front());
  while (around.grow()) {
  }
  const auto whole = around.patch();
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->quads.size(), pillowed.quads.size());
  EXPECT_EQ(whole->sides.size(), 4u);
  for (const auto& side : whole->sides) EXPECT_EQ(side.size(), 7u);
}

TEST(ConvexPatch, NoneBeginsOnAFeatureInside) {
  const Surface surface(test::flat_grid(10, 10));
  QuadMesh quads = sheet(6, 6);
  bind(quads, surface);
  const auto at = [](int i, int j) { return j * 7 + i; };
  for (int i = 2; i < 4; ++i) quads.feature_edges.push_back({at(i, 3), at(i + 1, 3), -1});
  const EditMesh mesh(quads, surface.mesh, surface.features);
  PatchGrower grower(mesh, 36);
  for (const int i : {2, 3, 4}) EXPECT_FALSE(grower.start(at(i, 3))) << "patches around it have the feature inside";
  for (const int v : {at(1, 3), at(3, 2), at(3, 0)}) EXPECT_TRUE(grower.start(v)) << "beside it, and on the boundary";
}

TEST(ChainArcLengths, OrderSurvivesPointsOutOfPlace) {
  std::vector<Vector3> points;
  for (int i = 0; i <= 20; ++i) points.emplace_back(i, 0, 0);
  const CurveGeometry line(points, false);
  std::vector<Vector3> chain = {{0, 0, 0}, {3, 1, 0}, {15, 1, 0}, {6, -1, 0}, {9, 0, 0}, {2, 0, 0}, {14, 0, 0}, {20, 0, 0}};
  const std::vector<double> arcs = chain_arc_lengths(line, chain, true);
  EXPECT_EQ(arcs.front(), 0);
  EXPECT_EQ(arcs.back(), 20);
  for (std::size_t i = 0; i + 1 < arcs.size(); ++i) EXPECT_LT(arcs[i], arcs[i + 1]);
  EXPECT_NEAR(arcs[1], 3, 1e-12);
  EXPECT_NEAR(arcs[6], 14, 1e-12);
}

TEST(ChainArcLengths, ClosedCurveIsCyclic) {
  std::vector<Vector3> points;
  for (int i = 0; i <= 24; ++i) points.emplace_back(std::cos(2 * M_PI * i / 24), std::sin(2 * M_PI * i / 24), 0);
  points.back() = points.front();
  const CurveGeometry ring(points, true);
  std::vector<Vector3> chain;
  for (int i = 0; i < 8; ++i) chain.push_back(ring.at(ring.length() * (0.7 + i / 8.0)));
  std::swap(chain[2], chain[3]);
  chain[0] = ring.at(0.2 * ring.length());  // the first one, far away
  const std::vector<double> arcs = chain_arc_lengths(ring, chain, false);
  double around = 0;
  for (int i = 0; i < 8; ++i) {
    const double step = ring.normalized(arcs[(i + 1) % 8] - arcs[i]);
    EXPECT_GT(step, 0);
    around += step;
  }
  EXPECT_NEAR(around, ring.length(), 1e-9);
}

TEST(CurveGeometry, ACircleBendsAlikeHoweverItsPointsAreSpaced) {
  std::vector<Vector3> points;
  double angle = 0;
  for (int i = 0; i < 36; ++i) {
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
    angle += (i % 5 < 2 ? 1.5 : 1) * 2 * M_PI / 43.5;
  }
  points.push_back(points[0]);
  CurveGeometry ring(points, true);
  ring.weigh_by_curvature(0.5, 20);
  double least = 1e300, most = 0;
  for (int i = 0; i < 360; ++i) {
    const double density = ring.weight_density(ring.length() * i / 360);
    least = std::min(least, density);
    most = std::max(most, density);
  }
  EXPECT_LT(most, 1.05 * least);
}

TEST(SurfaceWalk, FindsWhatTheTreeFindsOnASphere) {
  const Surface surface(test::icosphere(4));
  for (int i = 0; i < 100; ++i) {
    const Vector3 p = 1.1 * Vector3(std::sin(3.0 * i), std::cos(5.0 * i), std::sin(1.3 * i + 1)).normalized();
    const SurfacePoint walked = walk_to_nearest(surface.mesh, surface.features.face_region, p, i);
    EXPECT_NEAR(walked.squared_distance, surface.index->nearest(p).squared_distance, 1e-12);
  }
}

TEST(SurfaceWalk, StaysInItsRegion) {
  const Surface surface(test::box(4));
  for (int f = 0; f < surface.mesh.face_count(); f += 5) {
    const SurfacePoint walked = walk_to_nearest(surface.mesh, surface.features.face_region, Vector3(0.9, 2, 0.7), f);
    EXPECT_EQ(surface.features.face_region[walked.face], surface.features.face_region[f]);
  }
}

TEST(EditMesh, UndoRestoresEverything) {
  const Surface surface(test::icosphere(2));
  QuadMesh quads = sphere(3);
  bind(quads, surface);
  EditMesh mesh(quads, surface.mesh, surface.features);
  const auto incident = [&] {
    std::vector<std::vector<int>> lists;
    for (int v = 0; v < mesh.vertex_count(); ++v) lists.push_back(mesh.quads_at(v));
    return lists;
  };
  const auto before = incident();
  const std::size_t mark = mesh.mark();
  mesh.set_quad(0, mesh.quad(5), true);
  mesh.set_quad(7, mesh.quad(7), false);
  mesh.set_quad(0, {1, 2, 3, 4}, true);
  EXPECT_NE(incident(), before);
  mesh.undo_to(mark);
  EXPECT_EQ(incident(), before);
  for (int q = 0; q < mesh.quad_count(); ++q) EXPECT_EQ(mesh.quad(q), quads.quads[q]);
}

/// Quads of all valences on a unit cube, and a feature along each of its edges.
EditMesh muddled_cube(const Surface& surface) {
  QuadMesh quads = cube(4);
  bind(quads, surface);
  EditMesh mesh(quads, surface.mesh, surface.features);
  std::mt19937 random(7);
  for (int made = 0; made < 25;) {
    const Move move{static_cast<Move::Kind>(random() % 3), static_cast<int>(random() % mesh.quad_count()), static_cast<int>(random() % 4)};
    Changed changed;
    if (!may_move(mesh, move, &changed)) continue;
    make_move(mesh, move);
    ++made;
  }
  mesh.forget_log();
  return mesh;
}

TEST(QuadMoves, CostOfAMoveIsWhatTheWholeMeshCostsMoreAfterIt) {
  const Surface surface(test::box(4));
  EditMesh mesh = muddled_cube(surface);
  const auto whole_cost = [&mesh] {
    double sum = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) sum += valence_cost(mesh, v);
    return sum;
  };
  const double before = whole_cost();
  std::array<int, 4> tried{}, at_features{};
  for (const auto& [move, changed] : test::allowed_moves(mesh)) {
    const double cost = cost_of_move(mesh, move, changed);
    const std::size_t mark = mesh.mark();
    make_move(mesh, move);
    EXPECT_EQ(cost, whole_cost() - before) << "kind " << static_cast<int>(move.kind) << ", quad " << move.quad << ", corner " << move.corner;
    mesh.undo_to(mark);
    ++tried[move.kind];
    at_features[move.kind] += std::any_of(changed.vertex.begin(), changed.vertex.end(),
                                          [&mesh](int v) { return v >= 0 && !mesh.feature_links(v).empty(); });
  }
  for (const int number : tried) EXPECT_GT(number, 0);
  for (const int kind : {Move::kCollapse, Move::kRotateBack, Move::kRotateForth}) EXPECT_GT(at_features[kind], 0);
}

TEST(SequenceMemory, KnowsAVertexUntilQuadsNearItChange) {
  const Surface surface(test::flat_grid(10, 10));
  QuadMesh quads = sheet(24, 24);
  bind(quads, surface);
  EditMesh mesh(quads, surface.mesh, surface.features);
  constexpr int kDepth = 2;
  const int v = 12 * 25 + 12, near = quads.quads[10 * 24 + 14][0], far = 20 * 24 + 20;
  SequenceMemory memory;
  ASSERT_EQ(memory.recall(mesh, v, kDepth), nullptr);
  memory.remember(v, {17, {}});
  ASSERT_NE(memory.recall(mesh, v, kDepth), nullptr);
  EXPECT_EQ(memory.recall(mesh, v, kDepth)->trials, 17);
  const Move elsewhere{Move::kRotateBack, far, 0}, beside{Move::kRotateBack, mesh.quads_at(near)[0], 0};
  make_move(mesh, elsewhere);
  EXPECT_NE(memory.recall(mesh, v, kDepth), nullptr);
  const std::size_t mark = mesh.mark();
  make_move(mesh, beside);
  mesh.undo_to(mark);
  EXPECT_NE(memory.recall(mesh, v, kDepth), nullptr) << "what was undone is as before";
  make_move(mesh, beside);
  EXPECT_EQ(memory.recall(mesh, v, kDepth), nullptr);
}

TEST(SequenceSearch, FindsTheSameFromMemory) {
  const Surface surface(test::box(4));
  EditMesh mesh = muddled_cube(surface);
  constexpr SearchLimits kLimits{2, 3, 0.9, 400, 5, 3};
  SequenceMemory memory;
  const auto run = [&](SequenceMemory* of) {
    SequenceSearch search(mesh, 80, of);
    std::vector<std::vector<double>> costs;
    for (int v = 0; v < mesh.vertex_count() && !search.exhausted(); ++v) {
      costs.emplace_back();
      for (const Sequence& sequence : search.run_around(v, kLimits)) costs.back().push_back(sequence.cost);
    }
    return costs;
  };
  const auto without = run(nullptr), first = run(&memory), second = run(&memory);
  EXPECT_EQ(without, first);
  EXPECT_EQ(first, second);
  EXPECT_TRUE(std::any_of(first.begin(), first.end(), [](const auto& costs) { return !costs.empty(); }));
}

}  // namespace
}  // namespace hybrid_quad
