#include "hybrid_quad/mesh/edge_bisection.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <queue>
#include <utility>

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

/// Whether some edges have both ends in common, of a TriangleMesh or of an EditableMesh that edges were split in.
template <class Mesh>
bool has_edges_with_common_ends(const Mesh& mesh, int vertices, int halfedges) {
  // Half-edges, one an edge, sorted by their lower ends.
  std::vector<int> begin(vertices + 1, 0), seen_from(vertices, -1);
  const auto visit = [&](const auto& use) {
    for (int h = 0; h < halfedges; ++h)
      if (mesh.opposite(h) < h) use(std::min(mesh.from(h), mesh.to(h)), std::max(mesh.from(h), mesh.to(h)));
  };
  visit([&](int low, int) { ++begin[low + 1]; });
  for (int v = 0; v < vertices; ++v) begin[v + 1] += begin[v];
  std::vector<int> high_ends(begin.back()), end(begin.begin(), begin.end() - 1);
  visit([&](int low, int high) { high_ends[end[low]++] = high; });
  for (int v = 0; v < vertices; ++v)
    for (int i = begin[v]; i < begin[v + 1]; ++i) {
      if (seen_from[high_ends[i]] == v) return true;
      seen_from[high_ends[i]] = v;
    }
  return false;
}

/// In single precision: halves of an edge are equal, however the surface lies in space.
float squared(const Vector3& edge) { return static_cast<float>(edge.squaredNorm()); }
bool is_long(float squared_length, double longest) { return squared_length > static_cast<float>(longest * longest); }

bool has_long_edges(const TriangleMesh& mesh, double longest) {
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.opposite(h) < h && is_long(squared(mesh.edge_vector(h)), longest)) return true;
  return false;
}

/// \param mark_number  of half-edges, as marks_of() gives it
BisectedMesh with_marks(TriangleMesh mesh, std::vector<int> face_source, const std::vector<int>& mark_number,
                        const std::vector<Mark>& marks, std::size_t chain_count) {
  BisectedMesh out;
  out.chains.resize(chain_count);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (mark_number[h] < 0 || mesh.opposite(h) >= h) continue;
    const Mark& mark = marks[mark_number[h]];
    out.marked_edges.push_back({mesh.from(h), mesh.to(h)});
    out.source.push_back(mark.marked);
    if (mark.chain >= 0) out.chains[mark.chain].push_back(out.marked_edges.back());
  }
  out.mesh = std::move(mesh);
  out.face_source = std::move(face_source);
  return out;
}

/// Halves edges that have both ends in common with another until there are none: what comes after knows edges by their ends.
/// Cuts at non-manifold edges leave such edges.
void split_edges_with_common_ends(EditableMesh& edited) {
  while (has_edges_with_common_ends(edited, edited.vertex_slots(), edited.halfedge_slots())) {
    std::vector<std::pair<std::array<int, 2>, int>> edges;
    for (int h = 0; h < edited.halfedge_slots(); ++h)
      if (edited.opposite(h) < h) edges.push_back({sorted_pair(edited.from(h), edited.to(h)), h});
    std::sort(edges.begin(), edges.end());
    // One at a time of each face, none of the faces that come from it: splitting renames half-edges.
    std::vector<char> is_touched(edited.face_slots(), 0);
    const auto may_be_renamed = [&](int h) { return h / 3 >= static_cast<int>(is_touched.size()) || is_touched[h / 3]; };
    for (std::size_t i = 1; i < edges.size(); ++i) {
      if (edges[i].first != edges[i - 1].first) continue;
      const int h = edges[i].second, o = edited.opposite(h);
      if (may_be_renamed(h) || (o >= 0 && may_be_renamed(o))) continue;
      is_touched[h / 3] = 1;
      if (o >= 0) is_touched[o / 3] = 1;
      edited.split_edge(h, 0.5 * (edited.position(edited.from(h)) + edited.position(edited.to(h))));
    }
  }
}

struct LongEdge {
  float squared_length;
  int halfedge;
  bool operator<(const LongEdge& other) const {
    return squared_length != other.squared_length ? squared_length < other.squared_length : halfedge > other.halfedge;
  }
};

}  // namespace

BisectedMesh bisect_long_edges(const TriangleMesh& mesh, double longest, const EdgeSet& marked_edges,
                               const std::vector<EdgeSet>& chains, double most_splits) {
  std::vector<Mark> marks;
  std::vector<int> mark_number = marks_of(mesh, marked_edges, chains, marks);
  std::vector<int> faces(mesh.face_count());
  std::iota(faces.begin(), faces.end(), 0);
  if (!has_long_edges(mesh, longest) && !has_edges_with_common_ends(mesh, mesh.vertex_count(), mesh.halfedge_count()))
    return with_marks(mesh, std::move(faces), mark_number, marks, chains.size());
  EditableMesh edited(mesh, std::move(mark_number), std::move(faces));
  split_edges_with_common_ends(edited);
  std::priority_queue<LongEdge> queue;
  const auto squared_length = [&](int h) { return squared(edited.edge_vector(h)); };
  const auto push = [&](int h) {
    if (is_long(squared_length(h), longest)) queue.push({squared_length(h), h});
  };
  for (int h = 0; h < edited.halfedge_slots(); ++h)
    if (edited.opposite(h) < h) push(h);
  for (double splits = 0; !queue.empty() && splits < most_splits;) {
    const LongEdge edge = queue.top();
    queue.pop();
    if (squared_length(edge.halfedge) != edge.squared_length) continue;
    ++splits;
    const int from = edited.from(edge.halfedge), to = edited.to(edge.halfedge);
    const int middle = edited.split_edge(edge.halfedge, 0.5 * (edited.position(from) + edited.position(to)));
    // All sides of the new faces: splitting moved half-edges from one edge to another.
    edited.visit_outgoing(middle, [&](int h) {
      for (const int side : {h, EditableMesh::next(h), EditableMesh::previous(h)}) push(side);
    });
  }
  EditableMesh::Compacted compacted = edited.compacted();
  return with_marks(std::move(compacted.mesh), std::move(compacted.face_region), compacted.halfedge_curve, marks, chains.size());
}

double affordable_length(const TriangleMesh& mesh, double longest, double most_pieces) {
  for (;;) {
    double sum = 0;
    for (int h = 0; h < mesh.halfedge_count(); ++h)
      if (mesh.opposite(h) < h && mesh.edge_length(h) > longest) sum += mesh.edge_length(h);
    if (!(sum > 1.01 * most_pieces * longest)) return longest;  // nor ever longer where one of them is no number
    longest = sum / most_pieces;
  }
}

}  // namespace hybrid_quad
