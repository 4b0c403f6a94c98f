#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/mesh/quad_complex.h"
#include "hybrid_quad/mesh/segment_index.h"
#include "hybrid_quad/quality/quality.h"
#include "support/meshes.h"
#include "support/quad_complexes.h"

namespace hybrid_quad {
namespace {

/// Of the unit sphere, where it is cut at a height over the plane square to an axis.
GuideStroke circle(int axis, double height, double turn = 1, GuideKind kind = GuideKind::kLoop) {
  GuideStroke stroke;
  stroke.kind = kind;
  const double radius = std::sqrt(1 - height * height);
  for (int i = 0; i <= 60; ++i) {
    const double angle = turn * 2 * M_PI * i / 60;
    Vector3 p = Vector3::Zero();
    p[axis] = height;
    p[(axis + 1) % 3] = radius * std::cos(angle);
    p[(axis + 2) % 3] = radius * std::sin(angle);
    stroke.points.push_back(p);
  }
  if (turn == 1) stroke.points.back() = stroke.points.front();
  return stroke;
}

std::map<int, int> degrees(const EmbeddedStrokes& embedded) {
  std::map<int, int> degree;
  for (const GuideEdge& e : embedded.edges) {
    ++degree[e.a];
    ++degree[e.b];
  }
  std::map<int, int> count;
  for (const auto& [v, d] : degree) ++count[d];
  return count;
}

void expect_same_surface(const TriangleMesh& before, const EmbeddedStrokes& after) {
  const TriangleMesh& mesh = after.mesh;
  EXPECT_EQ(mesh.euler_characteristic(), before.euler_characteristic());
  EXPECT_NEAR(mesh.total_area(), before.total_area(), 1e-9 * before.total_area());
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.opposite(h) >= 0) {
      EXPECT_EQ(mesh.opposite(mesh.opposite(h)), h);
      EXPECT_EQ(mesh.from(h), mesh.to(mesh.opposite(h)));
    }
  for (int v = 0; v < before.vertex_count(); ++v) EXPECT_EQ(mesh.position(v), before.position(v));
  ASSERT_EQ(static_cast<int>(after.face.size()), mesh.face_count());
  for (int f = 0; f < mesh.face_count(); ++f)
    if (mesh.area(f) > 1e-9) {
      EXPECT_GT(mesh.normal(f).dot(before.normal(after.face[f])), 0.99);
    }
}

double distance_to_chain(const EmbeddedStrokes& embedded, const StrokeTrace& trace) {
  std::vector<std::array<Vector3, 2>> segments;
  for (const GuideEdge& e : embedded.edges) segments.push_back({embedded.mesh.position(e.a), embedded.mesh.position(e.b)});
  const SegmentIndex index(std::move(segments));
  double farthest = 0;
  for (const StrokeTrace::Run& run : trace.runs)
    for (const SurfacePoint& p : run.samples) farthest = std::max(farthest, std::sqrt(index.nearest(p.position).squared_distance));
  return farthest;
}

class Strokes : public testing::TestWithParam<int> {};  // levels of the sphere: triangles from far larger than quads to small

TEST_P(Strokes, BecomeChainsOnTheSameSurface) {
  const TriangleMesh sphere = test::icosphere(GetParam());
  constexpr double kLength = 0.1;
  struct Case {
    std::vector<GuideStroke> strokes;
    std::map<int, int> ends_and_crossings;  // degrees other than 2
  };
  const Case cases[] = {{{circle(2, 0.3)}, {}},
                        {{circle(2, 0.31, 0.4)}, {{1, 2}}},
                        {{circle(2, 0.1), circle(0, 0.2)}, {{4, 2}}}};
  for (const Case& c : cases) {
    const EmbeddedStrokes embedded = embed_strokes(sphere, {}, c.strokes, kLength, RunContext{});
    EXPECT_TRUE(embedded.warnings.empty());
    expect_same_surface(sphere, embedded);
    std::map<int, int> found = degrees(embedded);
    found.erase(2);
    EXPECT_EQ(found, c.ends_and_crossings);
    for (const StrokeTrace& trace : embedded.traces) EXPECT_LT(distance_to_chain(embedded, trace), 0.04 * kLength);
  }
}
INSTANTIATE_TEST_SUITE_P(Sphere, Strokes, testing::Values(1, 3, 5));

TEST(Strokes, MarkedEdgesThatAreCrossedStayMarked) {
  const TriangleMesh grid = test::flat_grid(10, 10);
  std::vector<std::array<int, 2>> marked;
  double length = 0;
  for (int h = 0; h < grid.halfedge_count(); ++h)
    if (grid.opposite(h) < h && std::abs(grid.position(grid.from(h)).x() - 0.5) + std::abs(grid.position(grid.to(h)).x() - 0.5) < 1e-9) {
      marked.push_back({grid.from(h), grid.to(h)});
      length += grid.edge_length(h);
    }
  ASSERT_FALSE(marked.empty());
  const EmbeddedStrokes embedded =
      embed_strokes(grid, marked, {{{Vector3(0.2, 0.43, 0), Vector3(0.8, 0.57, 0)}, GuideKind::kLoop}}, 0.1, RunContext{});
  EXPECT_GT(embedded.marked_edges.size(), marked.size());
  double now = 0;
  for (const auto& e : embedded.marked_edges) now += (embedded.mesh.position(e[0]) - embedded.mesh.position(e[1])).norm();
  EXPECT_NEAR(now, length, 1e-9);
}

TEST(Strokes, WhatLiesOffTheSurfaceIsSaid) {
  const TriangleMesh grid = test::flat_grid(10, 10);
  const GuideStroke far{{Vector3(0, 0, 5), Vector3(1, 1, 5)}, GuideKind::kLoop};
  const GuideStroke tiny{{Vector3(0.5, 0.5, 0), Vector3(0.501, 0.5, 0)}, GuideKind::kRing};
  const GuideStroke point{{Vector3(0.5, 0.5, 0)}, GuideKind::kRing};
  const EmbeddedStrokes embedded = embed_strokes(grid, {}, {far, tiny, point}, 0.1, RunContext{});
  EXPECT_EQ(embedded.warnings.size(), 3u);
  EXPECT_TRUE(embedded.edges.empty());
}

/// Quads of a grid in the plane with a chain of edges along one of its lines, as feature curve 0 after the boundary.
struct Grid {
  QuadMesh quads;
  TriangleMesh input;
  FeatureGraph before, after;
  std::vector<std::array<int, 2>> chain;
};

Grid grid_with_chain(double begin, double end) {
  constexpr int kCells = 10;
  Grid grid;
  grid.input = test::flat_grid(kCells, kCells);
  grid.quads = to_quad_mesh(test::quad_grid(kCells, kCells));
  double widest = 0;
  for (const Vector3& p : grid.quads.positions) widest = std::max(widest, p.x());
  for (Vector3& p : grid.quads.positions) p /= widest;
  const auto on_chain = [&](const Vector3& p) { return std::abs(p.y() - 0.5) < 1e-9 && p.x() > begin - 1e-9 && p.x() < end + 1e-9; };
  std::vector<char> is_feature(grid.input.halfedge_count(), 0);
  grid.after = trace_features(grid.input, is_feature);
  for (int h = 0; h < grid.input.halfedge_count(); ++h)
    is_feature[h] = on_chain(grid.input.position(grid.input.from(h))) && on_chain(grid.input.position(grid.input.to(h)));
  grid.before = trace_features(grid.input, is_feature);
  std::map<std::array<int, 2>, int> curve;
  const auto input_vertex = [&](int v) {
    for (int u = 0; u < grid.input.vertex_count(); ++u)
      if ((grid.input.position(u) - grid.quads.positions[v]).norm() < 1e-9) return u;
    return -1;
  };
  for (int h = 0; h < grid.input.halfedge_count(); ++h)
    if (grid.before.is_feature(h)) curve[{grid.input.from(h), grid.input.to(h)}] = grid.before.halfedge_curve[h];
  grid.quads.feature_edges.clear();
  for (const auto& q : grid.quads.quads)
    for (int i = 0; i < 4; ++i) {
      const int a = q[i], b = q[(i + 1) & 3];
      const auto found = curve.find({input_vertex(a), input_vertex(b)});
      const bool inside = on_chain(grid.quads.positions[a]) && on_chain(grid.quads.positions[b]);
      if (found == curve.end() || (inside && a > b)) continue;
      grid.quads.feature_edges.push_back({a, b, found->second});
      if (inside) grid.chain.push_back({a, b});
      for (const int v : {a, b}) {
        const int u = input_vertex(v);
        grid.quads.kind[v] = grid.before.is_corner[u] ? VertexKind::kCorner : VertexKind::kCurve;
        grid.quads.anchor[v] = grid.before.is_corner[u] ? u : found->second;
      }
    }
  return grid;
}

TEST(Rings, AChainThatEndsInsideBecomesAStrip) {
  for (const auto& [begin, end] : {std::array<double, 2>{0.3, 0.7}, {0.0, 0.6}, {0.0, 1.0}}) {
    Grid grid = grid_with_chain(begin, end);
    ASSERT_FALSE(grid.chain.empty());
    const std::size_t quads = grid.quads.quads.size();
    std::vector<GuideEdge> rings;
    ASSERT_TRUE(insert_ring(grid.quads, rings, 0, grid.chain, grid.input, grid.before, grid.after));
    EXPECT_TRUE(violations_of(grid.quads).empty());
    EXPECT_EQ(rings.size(), grid.chain.size() + 1);
    EXPECT_GT(grid.quads.quads.size(), quads);
    EXPECT_EQ(euler_characteristic(grid.quads), 1);
    EXPECT_EQ(shape_quality(grid.quads).irregular_vertices, 0);  // it goes straight on to the boundary
    for (const GuideEdge& e : rings) EXPECT_GT((grid.quads.positions[e.a] - grid.quads.positions[e.b]).norm(), 1e-3);
  }
}

/// Two rows of quads along a line, with the chain of edges between them on the only feature curve of `input`.
/// \param points  on the curve, in its direction  \param side  from each to the row on its left
QuadMesh rows_along(const std::vector<Vector3>& points, const std::vector<Vector3>& side, bool closed) {
  QuadMesh quads;
  const int n = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i)
    for (const int row : {-1, 0, 1}) {
      quads.positions.push_back(points[i] + row * side[i]);
      quads.kind.push_back(row != 0 ? VertexKind::kFree : closed || (i > 0 && i + 1 < n) ? VertexKind::kCurve : VertexKind::kCorner);
      quads.anchor.push_back(0);
      quads.near_face.push_back(-1);
    }
  for (int i = 0; i + (closed ? 0 : 1) < n; ++i) {
    const int a = 3 * i, b = 3 * ((i + 1) % n);
    quads.quads.push_back({a, b, b + 1, a + 1});
    quads.quads.push_back({a + 1, b + 1, b + 2, a + 2});
    quads.feature_edges.push_back({a + 1, b + 1, 0});
  }
  return quads;
}

struct FittedStroke {
  double before, after;  ///< distance from the stroke to the chain, in edges
  double moved;          ///< farthest, in edges
  bool ends_stay;
};

FittedStroke fitted(const TriangleMesh& mesh, const GuideStroke& stroke, int edges, const Vector3& normal) {
  constexpr double kLength = 0.1;
  const EmbeddedStrokes embedded = embed_strokes(mesh, {}, {stroke}, kLength, RunContext{});
  std::vector<char> is_feature(embedded.mesh.halfedge_count(), 0);
  std::set<std::array<int, 2>> on_stroke;
  for (const GuideEdge& e : embedded.edges) on_stroke.insert({std::min(e.a, e.b), std::max(e.a, e.b)});
  for (int h = 0; h < embedded.mesh.halfedge_count(); ++h) {
    const int a = embedded.mesh.from(h), b = embedded.mesh.to(h);
    is_feature[h] = on_stroke.count({std::min(a, b), std::max(a, b)}) > 0;
  }
  FeatureGraph features = trace_features(embedded.mesh, is_feature);
  int chosen = 0;  // the boundary of a mesh has curves as well
  for (int h = 0; h < embedded.mesh.halfedge_count(); ++h)
    if (is_feature[h]) chosen = features.halfedge_curve[h];
  std::swap(features.curves[0], features.curves[chosen]);
  const FeatureCurve& curve = features.curves[0];
  std::vector<Vector3> line;
  std::vector<double> arc{0};
  for (const int v : curve.vertices) {
    line.push_back(embedded.mesh.position(v));
    if (line.size() > 1) arc.push_back(arc.back() + (line.back() - line[line.size() - 2]).norm());
  }
  const auto at = [&](double s) {
    std::size_t i = 0;
    while (i + 2 < arc.size() && arc[i + 1] < s) ++i;
    return Vector3(line[i] + (s - arc[i]) / (arc[i + 1] - arc[i]) * (line[i + 1] - line[i]));
  };
  std::vector<Vector3> points, side;
  const double step = arc.back() / edges;
  for (int i = 0; i < edges + (curve.closed ? 0 : 1); ++i) points.push_back(at(i * step));
  const int n = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i) {
    const Vector3 &before = points[curve.closed ? (i + n - 1) % n : std::max(0, i - 1)],
                  &after = points[curve.closed ? (i + 1) % n : std::min(n - 1, i + 1)];
    side.push_back(0.8 * step * normal.cross(after - before).normalized());
  }
  QuadMesh quads = rows_along(points, side, curve.closed);
  const QuadMesh start = quads;
  std::vector<GuideEdge> chain;
  for (const QuadMesh::FeatureEdge& e : quads.feature_edges) chain.push_back({e.a, e.b, 0});
  FittedStroke result;
  result.before = measure_loop(embedded.traces[0], quads, chain, 0).distance;
  fit_to_curves(quads, embedded.mesh, features, std::vector<char>(features.curves.size(), 1), {});
  result.after = measure_loop(embedded.traces[0], quads, chain, 0).distance;
  result.moved = 0;
  for (std::size_t v = 0; v < quads.positions.size(); ++v)
    result.moved = std::max(result.moved, (quads.positions[v] - start.positions[v]).norm() / step);
  result.ends_stay = quads.positions[1] == start.positions[1] && quads.positions[3 * n - 2] == start.positions[3 * n - 2];
  return result;
}

TEST(Loops, ChainsStraddleARoundGuide) {
  const FittedStroke fit = fitted(test::icosphere(4), circle(2, 0.3), 12, Vector3(0, 0, 1));
  EXPECT_GT(fit.before, 0.05);
  EXPECT_LT(fit.after, 0.7 * fit.before);
}

TEST(Loops, VerticesSlideToABendWithinAnEdge) {
  const TriangleMesh grid = test::flat_grid(40, 40);
  const Vector3 corner(0.5, 0.5, 0);
  for (const double turn : {0.5, 0.8, 1.2}) {
    const Vector3 onward(std::cos(turn), std::sin(turn), 0);
    const GuideStroke stroke{{corner - Vector3(0.35, 0, 0), corner, corner + 0.35 * onward}, GuideKind::kLoop};
    const FittedStroke fit = fitted(grid, stroke, 7, Vector3(0, 0, 1));
    EXPECT_GT(fit.before, 0.1) << turn;
    EXPECT_LT(fit.after, 0.6 * fit.before) << turn;
    EXPECT_LT(fit.moved, 0.35) << turn;
    EXPECT_TRUE(fit.ends_stay) << turn;
  }
}

}  // namespace
}  // namespace hybrid_quad
