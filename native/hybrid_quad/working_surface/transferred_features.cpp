#include "hybrid_quad/working_surface/transferred_features.h"

#include <algorithm>
#include <string>
#include <utility>

#include "hybrid_quad/base/errors.h"

namespace hybrid_quad {

namespace {

class CurveTracer {
 public:
  CurveTracer(const TriangleMesh& mesh, FeatureGraph& graph, const std::vector<int>& input_vertex,
              const FeatureGraph& input)
      : mesh_(mesh), graph_(graph), input_vertex_(input_vertex), input_(input) {}

  void trace_all() {
    index_inner_vertices();
    collect_edges();
    for (int c = 0; c < static_cast<int>(input_.curves.size()); ++c) trace(c);
  }

 private:
  void index_inner_vertices();
  void collect_edges();
  void trace(int c);
  std::vector<int> follow(int c, int start) const;
  int start_of(int c) const;
  bool runs_backwards(const std::vector<int>& vertices, const FeatureCurve& input_curve) const;

  const TriangleMesh& mesh_;
  FeatureGraph& graph_;
  const std::vector<int>& input_vertex_;
  const FeatureGraph& input_;
  std::vector<int> rank_;       ///< place of an input vertex inside its curve, -1 for others and for corners
  std::vector<int> first_edge_; ///< #curves + 1, into edges_
  std::vector<int> edges_;
};

void CurveTracer::index_inner_vertices() {
  rank_.assign(input_.is_corner.size(), -1);
  for (const FeatureCurve& curve : input_.curves)
    for (int i = 0; i < static_cast<int>(curve.vertices.size()); ++i) {
      const int v = curve.vertices[i];
      if (!input_.is_corner[v] && rank_[v] < 0) rank_[v] = i;
    }
}

void CurveTracer::collect_edges() {
  const auto stands_for_edge = [this](int h) { return mesh_.is_boundary(h) || h < mesh_.opposite(h); };
  first_edge_.assign(input_.curves.size() + 1, 0);
  for (int h = 0; h < mesh_.halfedge_count(); ++h)
    if (graph_.is_feature(h) && stands_for_edge(h)) ++first_edge_[graph_.halfedge_curve[h] + 1];
  for (std::size_t c = 0; c + 1 < first_edge_.size(); ++c) first_edge_[c + 1] += first_edge_[c];
  edges_.resize(first_edge_.back());
  std::vector<int> fill(first_edge_.begin(), first_edge_.end() - 1);
  for (int h = 0; h < mesh_.halfedge_count(); ++h)
    if (graph_.is_feature(h) && stands_for_edge(h)) edges_[fill[graph_.halfedge_curve[h]]++] = h;
}

/// The input curve's first vertex, or what is left of a closed curve that is nearest to it.
int CurveTracer::start_of(int c) const {
  const FeatureCurve& curve = input_.curves[c];
  int start = -1, least = -1;
  for (int i = first_edge_[c]; i < first_edge_[c + 1]; ++i)
    for (const int v : {mesh_.from(edges_[i]), mesh_.to(edges_[i])}) {
      const int w = input_vertex_[v];
      if (w < 0) continue;
      if (!curve.closed) {
        if (w == curve.vertices.front()) return v;
      } else if (rank_[w] >= 0 && (least < 0 || rank_[w] < least)) {
        least = rank_[w];
        start = v;
      }
    }
  return start;
}

std::vector<int> CurveTracer::follow(int c, int start) const {
  // Ends of edges by vertex: a curve passes a vertex at most twice.
  std::vector<std::pair<int, int>> ends;
  for (int i = first_edge_[c]; i < first_edge_[c + 1]; ++i) {
    ends.push_back({mesh_.from(edges_[i]), edges_[i]});
    ends.push_back({mesh_.to(edges_[i]), edges_[i]});
  }
  std::sort(ends.begin(), ends.end());
  std::vector<int> vertices{start};
  int v = start, edge = -1;
  const int edge_count = first_edge_[c + 1] - first_edge_[c];
  for (int step = 0; step < edge_count; ++step) {
    auto it = std::lower_bound(ends.begin(), ends.end(), std::make_pair(v, -1));
    if (it != ends.end() && it->first == v && it->second == edge) ++it;
    if (it == ends.end() || it->first != v) break;
    edge = it->second;
    v = mesh_.from(edge) == v ? mesh_.to(edge) : mesh_.from(edge);
    vertices.push_back(v);
  }
  return vertices;
}

bool CurveTracer::runs_backwards(const std::vector<int>& vertices, const FeatureCurve& input_curve) const {
  if (input_curve.vertices.front() != input_curve.vertices.back()) return false;
  int up = 0, down = 0, last = -1;
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    const int w = input_vertex_[vertices[i]];
    if (w < 0 || rank_[w] < 0) continue;
    if (last >= 0) ++(rank_[w] > last ? up : down);
    last = rank_[w];
  }
  return down > up;
}

void CurveTracer::trace(int c) {
  FeatureCurve& curve = graph_.curves[c];
  const int start = start_of(c);
  if (start < 0) throw InternalError("working_surface", "curve " + std::to_string(c) + " lost its first vertex");
  curve.closed = input_.curves[c].closed;
  curve.boundary = input_.curves[c].boundary;
  curve.asked_count = input_.curves[c].asked_count;
  curve.vertices = follow(c, start);
  if (runs_backwards(curve.vertices, input_.curves[c])) std::reverse(curve.vertices.begin(), curve.vertices.end());
}

}  // namespace

FeatureGraph transferred_features(const TriangleMesh& mesh, std::vector<int> halfedge_curve, std::vector<int> face_region,
                                  const std::vector<int>& input_vertex, const FeatureGraph& input_features) {
  FeatureGraph graph;
  graph.halfedge_curve = std::move(halfedge_curve);
  graph.face_region = std::move(face_region);
  graph.curves.resize(input_features.curves.size());
  graph.is_corner.assign(mesh.vertex_count(), 0);
  graph.on_feature.assign(mesh.vertex_count(), 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (graph.is_feature(h)) graph.on_feature[mesh.from(h)] = graph.on_feature[mesh.to(h)] = 1;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    graph.is_corner[v] = input_vertex[v] >= 0 && input_features.is_corner[input_vertex[v]];
  CurveTracer(mesh, graph, input_vertex, input_features).trace_all();
  return graph;
}

}  // namespace hybrid_quad
