#include "hybrid_quad/mesh/canonical_order.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace hybrid_quad {

namespace {

/// What tells half-edges apart without their numbers: the greatest starts.
struct Rank {
  std::array<double, 3> lengths;  ///< squared, of this edge and the face's next two
  std::array<double, 9> corners;  ///< coordinates, for edges of equal length: these turn with the surface, lengths do not

  bool operator<(const Rank& other) const { return std::tie(lengths, corners) < std::tie(other.lengths, other.corners); }
};

Rank rank_of(const TriangleMesh& mesh, int h) {
  Rank rank{};
  for (int i = 0; i < 3; ++i, h = TriangleMesh::next(h)) {
    rank.lengths[i] = mesh.edge_vector(h).squaredNorm();
    for (int k = 0; k < 3; ++k) rank.corners[3 * i + k] = mesh.position(mesh.from(h))[k];
  }
  return rank;
}

/// For each component its half-edge of the greatest rank, the greatest component first.
std::vector<int> starts_of(const TriangleMesh& mesh) {
  std::vector<char> seen(mesh.face_count(), 0);
  std::vector<std::pair<Rank, int>> starts;
  std::vector<int> front;
  for (int seed = 0; seed < mesh.face_count(); ++seed) {
    if (seen[seed]) continue;
    seen[seed] = 1;
    front = {seed};
    std::pair<Rank, int> best{rank_of(mesh, 3 * seed), 3 * seed};
    for (std::size_t i = 0; i < front.size(); ++i)
      for (int h = 3 * front[i]; h < 3 * front[i] + 3; ++h) {
        const Rank rank = rank_of(mesh, h);
        if (best.first < rank) best = {rank, h};
        const int o = mesh.opposite(h);
        if (o < 0 || seen[o / 3]) continue;
        seen[o / 3] = 1;
        front.push_back(o / 3);
      }
    starts.push_back(best);
  }
  std::stable_sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return b.first < a.first; });
  std::vector<int> halfedges;
  for (const auto& [rank, h] : starts) halfedges.push_back(h);
  return halfedges;
}

}  // namespace

CanonicalOrder canonical_order(const TriangleMesh& mesh) {
  CanonicalOrder order;
  order.halfedge.reserve(mesh.halfedge_count());
  std::vector<char> seen_face(mesh.face_count(), 0), seen_vertex(mesh.vertex_count(), 0);
  const auto add = [&](int h) {
    seen_face[h / 3] = 1;
    for (int i = 0; i < 3; ++i, h = TriangleMesh::next(h)) {
      order.halfedge.push_back(h);
      if (seen_vertex[mesh.from(h)]) continue;
      seen_vertex[mesh.from(h)] = 1;
      order.vertex.push_back(mesh.from(h));
    }
  };
  for (const int start : starts_of(mesh)) {
    std::size_t next = order.halfedge.size();
    for (add(start); next < order.halfedge.size(); ++next) {
      const int o = mesh.opposite(order.halfedge[next]);
      if (o >= 0 && !seen_face[o / 3]) add(o);
    }
  }
  return order;
}

TriangleMesh reordered(const TriangleMesh& mesh, const CanonicalOrder& order) {
  std::vector<int> new_vertex(mesh.vertex_count(), -1), new_halfedge(mesh.halfedge_count(), -1), opposite;
  std::vector<Vector3> positions;
  for (const int v : order.vertex) {
    new_vertex[v] = static_cast<int>(positions.size());
    positions.push_back(mesh.position(v));
  }
  for (std::size_t h = 0; h < order.halfedge.size(); ++h) new_halfedge[order.halfedge[h]] = static_cast<int>(h);
  std::vector<std::array<int, 3>> faces(mesh.face_count());
  for (std::size_t h = 0; h < order.halfedge.size(); ++h) {
    const int o = mesh.opposite(order.halfedge[h]);
    faces[h / 3][h % 3] = new_vertex[mesh.from(order.halfedge[h])];
    opposite.push_back(o < 0 ? -1 : new_halfedge[o]);
  }
  return TriangleMesh(std::move(positions), std::move(faces), std::move(opposite));
}

}  // namespace hybrid_quad
