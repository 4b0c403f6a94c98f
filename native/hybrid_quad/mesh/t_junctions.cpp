#include "hybrid_quad/mesh/t_junctions.h"

#include <algorithm>
#include <utility>

#include "hybrid_quad/mesh/vertex_welding.h"

namespace hybrid_quad {

namespace {

constexpr int kMaxRounds = 4;             ///< a triangle may have such vertices on all three sides
constexpr std::size_t kMaxOpenEdges = 20000;  ///< beyond it the mesh is a soup, not a surface with cracks

/// Ends of open edges, sorted along the axis in which they spread most.
struct OpenVertices {
  std::vector<int> ids;
  int axis = 0;
};

OpenVertices open_vertices(const std::vector<Vector3>& positions, const std::vector<std::array<int, 2>>& edges) {
  OpenVertices open;
  for (const auto& e : edges) open.ids.insert(open.ids.end(), e.begin(), e.end());
  std::sort(open.ids.begin(), open.ids.end());
  open.ids.erase(std::unique(open.ids.begin(), open.ids.end()), open.ids.end());
  Vector3 low = positions[open.ids[0]], high = low;
  for (const int v : open.ids) {
    low = low.cwiseMin(positions[v]);
    high = high.cwiseMax(positions[v]);
  }
  (high - low).maxCoeff(&open.axis);
  std::stable_sort(open.ids.begin(), open.ids.end(),
                   [&](int v, int w) { return positions[v][open.axis] < positions[w][open.axis]; });
  return open;
}

/// The vertices inside the segment (a, b), with their place along it, in order.
std::vector<std::pair<double, int>> vertices_inside(const std::vector<Vector3>& positions, const OpenVertices& open,
                                                    double tolerance, int a, int b) {
  std::vector<std::pair<double, int>> inside;
  const Vector3 &p = positions[a], &q = positions[b];
  const Vector3 e = q - p;
  const double length = e.norm();
  if (!(length > 2 * tolerance)) return inside;
  const double low = std::min(p[open.axis], q[open.axis]) - tolerance, high = std::max(p[open.axis], q[open.axis]) + tolerance;
  auto it = std::lower_bound(open.ids.begin(), open.ids.end(), low,
                             [&](int v, double x) { return positions[v][open.axis] < x; });
  for (; it != open.ids.end() && positions[*it][open.axis] <= high; ++it) {
    const Vector3 d = positions[*it] - p;
    const double along = d.dot(e) / length;
    if (along <= 10 * tolerance || along >= length - 10 * tolerance) continue;
    if ((d - e * (along / length)).norm() <= tolerance) inside.push_back({along, *it});
  }
  std::sort(inside.begin(), inside.end());
  // Of several at one place, which are to be merged yet, one does.
  const auto is_at = [&](const auto& x, const auto& y) { return positions[x.second] == positions[y.second]; };
  inside.erase(std::unique(inside.begin(), inside.end(), is_at), inside.end());
  return inside;
}

}  // namespace

std::vector<int> split_at_t_junctions(const std::vector<Vector3>& positions, double tolerance,
                                      std::vector<std::array<int, 3>>& triangles, std::vector<int>& polygon) {
  std::vector<int> used;
  for (int round = 0; round < kMaxRounds; ++round) {
    const auto edges = open_edges(triangles);
    if (edges.empty() || edges.size() > kMaxOpenEdges) break;
    const OpenVertices open = open_vertices(positions, edges);
    const std::size_t before = used.size(), count = triangles.size();
    std::vector<std::array<int, 2>> sorted = edges;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t f = 0; f < count; ++f)
      for (int i = 0; i < 3; ++i) {
        const std::array<int, 3> t = triangles[f];
        const int a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
        if (!std::binary_search(sorted.begin(), sorted.end(), std::array<int, 2>{a, b})) continue;
        const auto inside = vertices_inside(positions, open, tolerance, a, b);
        int last = a;
        for (const auto& [along, v] : inside) {
          if (v == c) continue;
          if (last == a) triangles[f] = {a, v, c};
          else triangles.push_back({last, v, c}), polygon.push_back(polygon[f]);
          used.push_back(v);
          last = v;
        }
        if (last == a) continue;
        triangles.push_back({last, b, c});
        polygon.push_back(polygon[f]);
        break;  // its other sides come in the next round
      }
    if (used.size() == before) break;
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

}  // namespace hybrid_quad
