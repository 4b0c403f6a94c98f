#include "hybrid_quad/assemble/feature_chains.h"

#include <algorithm>
#include <tuple>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/segment_index.h"

namespace hybrid_quad {

namespace {

/// The edges of one curve as a walk of vertices, from an end or a corner if there is one.
std::vector<int> walk_chain(const QuadMesh& quads, const std::vector<QuadMesh::FeatureEdge>& edges) {
  std::vector<std::pair<int, int>> links;  // (vertex, edge), sorted by vertex
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    links.emplace_back(edges[e].a, e);
    links.emplace_back(edges[e].b, e);
  }
  std::sort(links.begin(), links.end());
  const auto at = [&](int v) { return std::lower_bound(links.begin(), links.end(), std::make_pair(v, -1)); };
  int start = edges[0].a;
  for (const auto& [v, e] : links)
    if (quads.kind[v] == VertexKind::kCorner) {
      start = v;
      break;
    }
  std::vector<char> used(edges.size(), 0);
  std::vector<int> chain{start};
  for (bool go_on = true; go_on;) {
    go_on = false;
    for (auto l = at(chain.back()); l != links.end() && l->first == chain.back(); ++l) {
      if (used[l->second]) continue;
      used[l->second] = 1;
      const QuadMesh::FeatureEdge& e = edges[l->second];
      chain.push_back(e.a == chain.back() ? e.b : e.a);
      go_on = true;
      break;
    }
  }
  if (chain.size() != edges.size() + 1) throw InternalError("assemble", "the edges on a feature curve are not one chain");
  return chain;
}

/// Whether the walk runs along the curve: by the steps of arc length of its vertices' nearest points.
bool runs_along(const std::vector<int>& chain, const QuadMesh& quads, const TriangleMesh& input, const FeatureCurve& curve) {
  std::vector<std::array<Vector3, 2>> segments;
  std::vector<double> start{0};
  for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i) {
    segments.push_back({input.position(curve.vertices[i]), input.position(curve.vertices[i + 1])});
    start.push_back(start.back() + (segments.back()[1] - segments.back()[0]).norm());
  }
  const SegmentIndex index(std::move(segments));
  const double length = start.back();
  std::vector<double> arc;
  for (const int v : chain) {
    const SegmentPoint p = index.nearest(quads.positions[v]);
    arc.push_back(start[p.segment] + p.fraction * (start[p.segment + 1] - start[p.segment]));
  }
  double forward = 0;
  for (std::size_t i = 0; i + 1 < arc.size(); ++i) {
    double step = arc[i + 1] - arc[i];
    // Across the seam of a loop the step is the short way round.
    if (chain.front() == chain.back() && 2 * std::abs(step) > length) step += step > 0 ? -length : length;
    forward += step;
  }
  return forward >= 0;
}

}  // namespace

void order_feature_edges(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features) {
  std::vector<QuadMesh::FeatureEdge>& edges = quads.feature_edges;
  std::sort(edges.begin(), edges.end(), [](const auto& x, const auto& y) {
    return std::tie(x.curve, x.a, x.b) < std::tie(y.curve, y.a, y.b);
  });
  std::vector<QuadMesh::FeatureEdge> ordered;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j].curve == edges[i].curve) ++j;
    std::vector<int> chain = walk_chain(quads, {edges.begin() + i, edges.begin() + j});
    const int c = edges[i].curve;
    if (!runs_along(chain, quads, input, features.curves[c])) std::reverse(chain.begin(), chain.end());
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) ordered.push_back({chain[k], chain[k + 1], c});
    i = j;
  }
  edges = std::move(ordered);
}

}  // namespace hybrid_quad
