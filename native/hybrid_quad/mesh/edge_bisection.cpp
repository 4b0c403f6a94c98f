#include "hybrid_quad/mesh/edge_bisection.h"

#include <algorithm>
#include <queue>

#include "hybrid_quad/mesh/editable_mesh.h"

namespace hybrid_quad {

namespace {

constexpr int kMarked = 0;

std::array<int, 2> sorted_pair(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// kMarked on the half-edges of marked edges, -1 elsewhere.
std::vector<int> marks_of(const TriangleMesh& mesh, const std::vector<std::array<int, 2>>& marked_edges) {
  std::vector<std::array<int, 2>> sorted;
  for (const auto& e : marked_edges) sorted.push_back(sorted_pair(e[0], e[1]));
  std::sort(sorted.begin(), sorted.end());
  std::vector<int> marks(mesh.halfedge_count(), -1);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (std::binary_search(sorted.begin(), sorted.end(), sorted_pair(mesh.from(h), mesh.to(h)))) marks[h] = kMarked;
  return marks;
}

struct LongEdge {
  double squared_length;
  int halfedge;
  bool operator<(const LongEdge& other) const {
    return squared_length != other.squared_length ? squared_length < other.squared_length : halfedge > other.halfedge;
  }
};

}  // namespace

BisectedMesh bisect_long_edges(const TriangleMesh& mesh, double longest, const std::vector<std::array<int, 2>>& marked_edges) {
  EditableMesh edited(mesh, marks_of(mesh, marked_edges));
  std::priority_queue<LongEdge> queue;
  const auto push = [&](int h) {
    const double squared = edited.edge_vector(h).squaredNorm();
    if (squared > longest * longest) queue.push({squared, h});
  };
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.opposite(h) < h) push(h);
  while (!queue.empty()) {
    const LongEdge edge = queue.top();
    queue.pop();
    if (edited.edge_vector(edge.halfedge).squaredNorm() != edge.squared_length) continue;
    const int from = edited.from(edge.halfedge), to = edited.to(edge.halfedge);
    const int middle = edited.split_edge(edge.halfedge, 0.5 * (edited.position(from) + edited.position(to)));
    // All sides of the new faces: splitting moved half-edges from one edge to another.
    edited.visit_outgoing(middle, [&](int h) {
      for (const int side : {h, EditableMesh::next(h), EditableMesh::previous(h)}) push(side);
    });
  }
  EditableMesh::Compacted compacted = edited.compacted();
  BisectedMesh out;
  for (int h = 0; h < compacted.mesh.halfedge_count(); ++h)
    if (compacted.halfedge_curve[h] == kMarked && compacted.mesh.opposite(h) < h)
      out.marked_edges.push_back({compacted.mesh.from(h), compacted.mesh.to(h)});
  out.mesh = std::move(compacted.mesh);
  return out;
}

}  // namespace hybrid_quad
