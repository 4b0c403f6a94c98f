#include "hybrid_quad/mesh/edge_bisection.h"

#include <algorithm>
#include <map>
#include <queue>

#include "hybrid_quad/mesh/editable_mesh.h"

namespace hybrid_quad {

namespace {

std::array<int, 2> sorted_pair(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// What an edge is one of.
struct Mark {
  int marked = -1, chain = -1;
};

/// The edges that are marked or on a chain, and on half-edges which of these they are, -1 elsewhere.
std::vector<int> marks_of(const TriangleMesh& mesh, const EdgeSet& marked_edges, const std::vector<EdgeSet>& chains,
                          std::vector<Mark>& marks) {
  std::map<std::array<int, 2>, Mark> mark_of;
  for (std::size_t i = 0; i < marked_edges.size(); ++i)
    mark_of[sorted_pair(marked_edges[i][0], marked_edges[i][1])].marked = static_cast<int>(i);
  for (std::size_t i = 0; i < chains.size(); ++i)
    for (const auto& e : chains[i]) mark_of[sorted_pair(e[0], e[1])].chain = static_cast<int>(i);
  std::vector<int> number(mesh.halfedge_count(), -1);
  if (mark_of.empty()) return number;
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const auto found = mark_of.find(sorted_pair(mesh.from(h), mesh.to(h)));
    if (found == mark_of.end() || number[h] >= 0) continue;
    number[h] = static_cast<int>(marks.size());
    if (mesh.opposite(h) >= 0) number[mesh.opposite(h)] = number[h];
    marks.push_back(found->second);
  }
  return number;
}

struct LongEdge {
  double squared_length;
  int halfedge;
  bool operator<(const LongEdge& other) const {
    return squared_length != other.squared_length ? squared_length < other.squared_length : halfedge > other.halfedge;
  }
};

}  // namespace

BisectedMesh bisect_long_edges(const TriangleMesh& mesh, double longest, const EdgeSet& marked_edges,
                               const std::vector<EdgeSet>& chains) {
  std::vector<Mark> marks;
  EditableMesh edited(mesh, marks_of(mesh, marked_edges, chains, marks));
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
  out.chains.resize(chains.size());
  for (int h = 0; h < compacted.mesh.halfedge_count(); ++h) {
    if (compacted.halfedge_curve[h] < 0 || compacted.mesh.opposite(h) >= h) continue;
    const Mark& mark = marks[compacted.halfedge_curve[h]];
    out.marked_edges.push_back({compacted.mesh.from(h), compacted.mesh.to(h)});
    out.source.push_back(mark.marked);
    if (mark.chain >= 0) out.chains[mark.chain].push_back(out.marked_edges.back());
  }
  out.mesh = std::move(compacted.mesh);
  return out;
}

}  // namespace hybrid_quad
