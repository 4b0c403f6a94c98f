#include <algorithm>
#include <cmath>
#include <string>

#include "hybrid_quad/features/features.h"

namespace hybrid_quad {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

/// The half-edge that stands for its edge.
int edge_of(const TriangleMesh& mesh, int h) { return mesh.opposite(h) < 0 ? h : std::min(h, mesh.opposite(h)); }

/// Feature edges about each vertex, in the order of their half-edges.
struct Incidence {
  std::vector<int> first;  ///< #V + 1
  std::vector<int> edges;
  int degree(int v) const { return first[v + 1] - first[v]; }
};

Incidence incident_feature_edges(const TriangleMesh& mesh, const std::vector<char>& is_feature) {
  Incidence in;
  in.first.assign(mesh.vertex_count() + 1, 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (is_feature[h] && edge_of(mesh, h) == h) {
      ++in.first[mesh.from(h) + 1];
      ++in.first[mesh.to(h) + 1];
    }
  for (int v = 0; v < mesh.vertex_count(); ++v) in.first[v + 1] += in.first[v];
  in.edges.resize(in.first.back());
  std::vector<int> fill(in.first.begin(), in.first.end() - 1);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (is_feature[h] && edge_of(mesh, h) == h) {
      in.edges[fill[mesh.from(h)]++] = h;
      in.edges[fill[mesh.to(h)]++] = h;
    }
  return in;
}

/// The first vertex on a chain of features from v, over `edge`, that is at least so far from v, or the last before a junction.
Vector3 ahead_of(const TriangleMesh& mesh, const Incidence& in, int v, int edge, double distance) {
  const int start = v;
  for (;;) {
    v = mesh.other_end(edge, v);
    if (v == start || in.degree(v) != 2 || (mesh.position(v) - mesh.position(start)).norm() >= distance) return mesh.position(v);
    const int* at = &in.edges[in.first[v]];
    edge = at[0] == edge ? at[1] : at[0];
  }
}

/// \pre v has two feature edges
bool turns_sharply(const TriangleMesh& mesh, const Incidence& in, int v, const CornerRule& rule) {
  const int* edges = &in.edges[in.first[v]];
  const auto turns = [&](double distance) {
    const Vector3 a = ahead_of(mesh, in, v, edges[0], distance) - mesh.position(v);
    const Vector3 b = ahead_of(mesh, in, v, edges[1], distance) - mesh.position(v);
    return a.dot(b) > std::cos(rule.angle * kDegree) * a.norm() * b.norm() && a.squaredNorm() > 0 && b.squaredNorm() > 0;
  };
  return turns(0) && turns(rule.reach);
}

void mark_corners(const TriangleMesh& mesh, const Incidence& in, const CornerRule& rule, FeatureGraph& graph) {
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int degree = in.degree(v);
    graph.on_feature[v] = degree > 0;
    graph.is_corner[v] = degree == 1 || degree > 2 || (degree == 2 && turns_sharply(mesh, in, v, rule));
  }
}

/// Follows the curve that leaves v along `edge` until a corner or back to v.
void trace_curve(const TriangleMesh& mesh, const Incidence& in, int v, int edge, FeatureGraph& graph) {
  const int id = static_cast<int>(graph.curves.size());
  const int start = v;
  FeatureCurve curve;
  curve.boundary = mesh.is_boundary(edge);
  curve.vertices.push_back(v);
  for (;;) {
    graph.halfedge_curve[edge] = id;
    if (!mesh.is_boundary(edge)) graph.halfedge_curve[mesh.opposite(edge)] = id;
    v = mesh.other_end(edge, v);
    curve.vertices.push_back(v);
    if (graph.is_corner[v] || v == start) break;
    const int* at = &in.edges[in.first[v]];
    edge = at[0] == edge ? at[1] : at[0];
  }
  curve.closed = !graph.is_corner[start];
  graph.curves.push_back(std::move(curve));
}

void flood_regions(const TriangleMesh& mesh, FeatureGraph& graph) {
  std::vector<int> stack;
  int region = 0;
  for (int seed = 0; seed < mesh.face_count(); ++seed) {
    if (graph.face_region[seed] >= 0) continue;
    graph.face_region[seed] = region;
    stack.push_back(seed);
    while (!stack.empty()) {
      const int f = stack.back();
      stack.pop_back();
      for (int h = 3 * f; h < 3 * f + 3; ++h) {
        if (graph.is_feature(h)) continue;
        const int g = mesh.opposite(h) / 3;
        if (graph.face_region[g] >= 0) continue;
        graph.face_region[g] = region;
        stack.push_back(g);
      }
    }
    ++region;
  }
}

}  // namespace

FeatureGraph trace_features(const TriangleMesh& mesh, const std::vector<char>& is_feature, const CornerRule& rule,
                            const std::vector<int>& corners) {
  std::vector<char> marked = is_feature;
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.is_boundary(h)) marked[h] = 1;
  const Incidence in = incident_feature_edges(mesh, marked);

  FeatureGraph graph;
  graph.halfedge_curve.assign(mesh.halfedge_count(), -1);
  graph.is_corner.assign(mesh.vertex_count(), 0);
  graph.on_feature.assign(mesh.vertex_count(), 0);
  graph.face_region.assign(mesh.face_count(), -1);
  mark_corners(mesh, in, rule, graph);
  for (const int v : corners) graph.is_corner[v] = graph.on_feature[v];
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (graph.is_corner[v])
      for (int i = in.first[v]; i < in.first[v + 1]; ++i)
        if (!graph.is_feature(in.edges[i])) trace_curve(mesh, in, v, in.edges[i], graph);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (marked[h] && !graph.is_feature(h)) trace_curve(mesh, in, mesh.from(h), edge_of(mesh, h), graph);
  flood_regions(mesh, graph);
  return graph;
}

namespace {

void check_sizes(const FeatureGraph& g, const TriangleMesh& mesh, std::vector<std::string>& found) {
  if (static_cast<int>(g.halfedge_curve.size()) != mesh.halfedge_count()) found.push_back("halfedge_curve has a wrong size");
  if (static_cast<int>(g.face_region.size()) != mesh.face_count()) found.push_back("face_region has a wrong size");
  if (static_cast<int>(g.is_corner.size()) != mesh.vertex_count() ||
      static_cast<int>(g.on_feature.size()) != mesh.vertex_count())
    found.push_back("is_corner or on_feature has a wrong size");
}

void check_halfedges(const FeatureGraph& g, const TriangleMesh& mesh, std::vector<std::string>& found) {
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const std::string at = " at half-edge " + std::to_string(h);
    if (g.halfedge_curve[h] >= static_cast<int>(g.curves.size())) found.push_back("unknown curve" + at);
    else if (mesh.is_boundary(h) && (g.halfedge_curve[h] < 0 || !g.curves[g.halfedge_curve[h]].boundary))
      found.push_back("boundary without a boundary curve" + at);
    else if (!mesh.is_boundary(h) && g.halfedge_curve[h] != g.halfedge_curve[mesh.opposite(h)])
      found.push_back("the sides of an edge disagree about its curve" + at);
    else if (g.halfedge_curve[h] < 0 && g.face_region[h / 3] != g.face_region[mesh.opposite(h) / 3])
      found.push_back("two regions meet across no curve" + at);
    if (g.halfedge_curve[h] >= 0 && (!g.on_feature[mesh.from(h)] || !g.on_feature[mesh.to(h)]))
      found.push_back("on_feature misses an end" + at);
  }
}

/// An edge of the given curve between a and b.
bool has_curve_edge(const FeatureGraph& g, const TriangleMesh& mesh, int a, int b, int curve) {
  bool any = false;
  mesh.visit_edges_at(a, [&](int h) { any |= mesh.other_end(h, a) == b && g.halfedge_curve[h] == curve; });
  return any;
}

void check_curve(const FeatureGraph& g, const TriangleMesh& mesh, int c, std::vector<std::string>& found) {
  const std::string name = "curve " + std::to_string(c);
  const std::vector<int>& v = g.curves[c].vertices;
  if (v.size() < 2) {
    found.push_back(name + " has no edge");
    return;
  }
  for (std::size_t i = 0; i + 1 < v.size(); ++i)
    if (!has_curve_edge(g, mesh, v[i], v[i + 1], c)) found.push_back(name + " leaves its edges");
  for (std::size_t i = 1; i + 1 < v.size(); ++i)
    if (g.is_corner[v[i]]) found.push_back(name + " runs through a corner");
  if (g.curves[c].closed ? v.front() != v.back() || g.is_corner[v.front()]
                         : !g.is_corner[v.front()] || !g.is_corner[v.back()])
    found.push_back(name + " ends badly");
}

}  // namespace

std::vector<std::string> violations_of(const FeatureGraph& features, const TriangleMesh& mesh) {
  std::vector<std::string> found;
  check_sizes(features, mesh, found);
  if (!found.empty()) return found;
  check_halfedges(features, mesh, found);
  if (!found.empty()) return found;
  std::size_t curve_edges = 0, feature_edges = 0;
  for (int c = 0; c < static_cast<int>(features.curves.size()); ++c) {
    check_curve(features, mesh, c, found);
    curve_edges += features.curves[c].vertices.size() - 1;
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h) feature_edges += features.is_feature(h) && edge_of(mesh, h) == h;
  if (curve_edges != feature_edges) found.push_back("the curves do not cover the feature edges once");
  return found;
}

}  // namespace hybrid_quad
