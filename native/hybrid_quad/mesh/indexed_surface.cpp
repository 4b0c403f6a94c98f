#include "hybrid_quad/mesh/indexed_surface.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace hybrid_quad {

namespace {

int root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

int next_in_face(int h) { return h % 3 == 2 ? h - 2 : h + 1; }

IndexedSurface with_own_fans(const BuiltMesh& built) {
  const TriangleMesh& mesh = built.mesh;
  // Of corners, each named by the half-edge that begins there: those of one fan have one root.
  std::vector<int> fan(mesh.halfedge_count());
  std::iota(fan.begin(), fan.end(), 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.opposite(h) >= 0) fan[root(fan, h)] = root(fan, next_in_face(mesh.opposite(h)));
  std::vector<std::vector<int>> fans_of(mesh.vertex_count());
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (root(fan, h) == h) fans_of[mesh.from(h)].push_back(h);

  IndexedSurface out;
  std::vector<int> vertex_of_fan(mesh.halfedge_count(), -1);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    for (const int h : fans_of[v]) {
      vertex_of_fan[h] = static_cast<int>(out.positions.size());
      out.positions.push_back(mesh.position(v));
      out.input_vertex.push_back(built.input_vertex[v]);
    }
  out.triangles.resize(mesh.face_count());
  for (int h = 0; h < mesh.halfedge_count(); ++h) out.triangles[h / 3][h % 3] = vertex_of_fan[root(fan, h)];
  out.input_face = built.input_face;
  return out;
}

/// Halves edges, each named by one of its half-edges.
class EdgeHalver {
 public:
  EdgeHalver(const TriangleMesh& mesh, IndexedSurface& surface) : surface_(surface), middle_(mesh.halfedge_count(), kNone) {
    std::map<std::array<int, 2>, std::vector<int>> edges_of_ends;
    for (int h = 0; h < mesh.halfedge_count(); ++h) {
      const int edge = mesh.opposite(h) < 0 ? h : std::min(h, mesh.opposite(h));
      edges_.push_back(edge);
      const std::array<int, 3>& face = surface.triangles[h / 3];
      const auto ends = std::minmax(face[h % 3], face[(h + 1) % 3]);
      if (edge == h) edges_of_ends[{ends.first, ends.second}].push_back(edge);
    }
    for (const auto& [ends, edges] : edges_of_ends)
      for (const int edge : edges)
        if (edges.size() > 1) middle_[edge] = kAsked;
  }

  void run() {
    for (std::size_t f = 0; f < surface_.triangles.size(); ++f)
      for (int side = 0; side < 3; ++side)
        while (is_asked(edges_[3 * f + side])) split(static_cast<int>(f), side);
  }

 private:
  static constexpr int kNone = -2, kAsked = -1;  // instead of the vertex in an edge's middle
  static constexpr int kNew = -1;                // instead of the name of an edge that was there

  bool is_asked(int edge) const { return edge != kNew && middle_[edge] != kNone; }

  /// Face (a, b, c) becomes (a, m, c) and, at the end of the list, (m, b, c).
  void split(int f, int side) {
    const std::array<int, 3> face = surface_.triangles[f];
    const int a = face[side], b = face[(side + 1) % 3], c = face[(side + 2) % 3];
    const int edge = edges_[3 * f + side], after = edges_[3 * f + (side + 1) % 3];
    if (middle_[edge] == kAsked) {
      middle_[edge] = static_cast<int>(surface_.positions.size());
      surface_.positions.push_back(0.5 * (surface_.positions[a] + surface_.positions[b]));
      surface_.input_vertex.push_back(-1);
    }
    const int m = middle_[edge];
    surface_.triangles[f][(side + 1) % 3] = m;
    edges_[3 * f + side] = edges_[3 * f + (side + 1) % 3] = kNew;
    surface_.triangles.push_back({m, b, c});
    surface_.input_face.push_back(surface_.input_face[f]);
    edges_.insert(edges_.end(), {kNew, after, kNew});
  }

  IndexedSurface& surface_;
  std::vector<int> edges_;   ///< 3 #F: the edge that a side is
  std::vector<int> middle_;  ///< of edges
};

}  // namespace

IndexedSurface indexed_surface(const BuiltMesh& built) {
  IndexedSurface out = with_own_fans(built);
  EdgeHalver(built.mesh, out).run();
  return out;
}

}  // namespace hybrid_quad
