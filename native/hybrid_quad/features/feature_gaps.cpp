#include "hybrid_quad/features/feature_gaps.h"

#include <functional>
#include <map>
#include <queue>
#include <utility>

namespace hybrid_quad {

namespace {

constexpr double kDetour = 2;  ///< what is no farther than so many ways along features is reached already

class Gaps {
 public:
  Gaps(const TriangleMesh& mesh, const std::vector<char>& is_feature, double reach)
      : mesh_(mesh), is_feature_(is_feature), reach_(reach) {
    for (int h = 0; h < mesh.halfedge_count(); ++h)
      if (mesh.is_boundary(h)) is_feature_[h] = 1;
  }

  int degree(int v) const {
    int degree = 0;
    mesh_.visit_edges_at(v, [&](int h) { degree += is_feature_[h]; });
    return degree;
  }

  /// The way from a loose end, whose edges are features from now on.
  std::vector<int> close(int tip) {
    const Search along = search(tip, kDetour * reach_, true), beside = search(tip, reach_, false);
    int goal = -1;
    for (const auto& [v, distance] : beside.distance)
      if (v != tip && !along.distance.count(v) && degree(v) > 0 && (goal < 0 || distance < beside.distance.at(goal))) goal = v;
    std::vector<int> way;
    for (int v = goal; v >= 0 && v != tip; v = mesh_.other_end(way.back(), v)) way.push_back(beside.came.at(v));
    for (const int h : way) {
      is_feature_[h] = 1;
      if (mesh_.opposite(h) >= 0) is_feature_[mesh_.opposite(h)] = 1;
    }
    return way;
  }

 private:
  struct Search {
    std::map<int, double> distance;  ///< of vertices
    std::map<int, int> came;         ///< the edge that leads to each
  };

  /// Vertices near one along features, or along all other edges (Dijkstra).
  Search search(int start, double reach, bool along_features) const {
    Search found;
    found.distance[start] = 0;
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> waiting;
    waiting.push({0, start});
    while (!waiting.empty()) {
      const auto [so_far, v] = waiting.top();
      waiting.pop();
      if (so_far > found.distance.at(v)) continue;
      mesh_.visit_edges_at(v, [&, from = v, done = so_far](int h) {
        const double distance = done + mesh_.edge_length(h);
        if ((is_feature_[h] != 0) != along_features || distance > reach) return;
        const int to = mesh_.other_end(h, from);
        const auto known = found.distance.find(to);
        if (known != found.distance.end() && known->second <= distance) return;
        found.distance[to] = distance;
        found.came[to] = h;
        waiting.push({distance, to});
      });
    }
    return found;
  }

  const TriangleMesh& mesh_;
  std::vector<char> is_feature_;
  double reach_;
};

}  // namespace

std::vector<int> ways_over_gaps(const TriangleMesh& mesh, const std::vector<char>& is_feature, double reach, const RunContext& context) {
  Gaps gaps(mesh, is_feature, reach);
  std::vector<int> edges;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if ((v & 0xffff) == 0) context.checkpoint(0.4);
    if (mesh.outgoing(v) < 0 || gaps.degree(v) != 1) continue;
    const std::vector<int> way = gaps.close(v);
    edges.insert(edges.end(), way.begin(), way.end());
  }
  return edges;
}

}  // namespace hybrid_quad
