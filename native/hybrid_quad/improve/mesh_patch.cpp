#include "hybrid_quad/improve/mesh_patch.h"

#include <algorithm>
#include <array>

namespace hybrid_quad {

namespace {

bool has_side(const std::array<int, 4>& quad, int a, int b) {
  for (int i = 0; i < 4; ++i) {
    const int from = quad[i], to = quad[(i + 1) & 3];
    if ((from == a && to == b) || (from == b && to == a)) return true;
  }
  return false;
}

/// The number of the k-th in the whole, of which there are `count`: for a new one the next that is free.
int number_of(const std::vector<int>& known, std::size_t k, std::size_t count) {
  return k < known.size() ? known[k] : static_cast<int>(count + k - known.size());
}

}  // namespace

MeshPatch cut_patch(const QuadMesh& whole, const std::vector<int>& quads) {
  MeshPatch patch;
  patch.quads = quads;
  for (const int q : quads) patch.vertices.insert(patch.vertices.end(), whole.quads[q].begin(), whole.quads[q].end());
  std::sort(patch.vertices.begin(), patch.vertices.end());
  patch.vertices.erase(std::unique(patch.vertices.begin(), patch.vertices.end()), patch.vertices.end());
  const auto local = [&](int v) {
    const auto at = std::lower_bound(patch.vertices.begin(), patch.vertices.end(), v);
    return at != patch.vertices.end() && *at == v ? static_cast<int>(at - patch.vertices.begin()) : -1;
  };
  for (const int v : patch.vertices) {
    patch.mesh.positions.push_back(whole.positions[v]);
    patch.mesh.kind.push_back(whole.kind[v]);
    patch.mesh.anchor.push_back(whole.anchor[v]);
    patch.mesh.near_face.push_back(whole.near_face[v]);
  }
  for (const int q : quads) {
    const auto& v = whole.quads[q];
    patch.mesh.quads.push_back({local(v[0]), local(v[1]), local(v[2]), local(v[3])});
  }
  for (std::size_t e = 0; e < whole.feature_edges.size(); ++e) {
    const QuadMesh::FeatureEdge& edge = whole.feature_edges[e];
    const int a = local(edge.a), b = local(edge.b);
    if (a < 0 || b < 0) continue;
    if (std::none_of(patch.mesh.quads.begin(), patch.mesh.quads.end(), [&](const auto& quad) { return has_side(quad, a, b); })) continue;
    patch.feature_edges.push_back(static_cast<int>(e));
    patch.mesh.feature_edges.push_back({a, b, edge.curve});
  }
  return patch;
}

void put_back(const MeshPatch& patch, QuadMesh& whole) {
  const std::size_t vertices = whole.positions.size(), quads = whole.quads.size(), edges = whole.feature_edges.size();
  const std::size_t more_vertices = vertices + patch.mesh.positions.size() - patch.vertices.size();
  whole.positions.resize(more_vertices);
  whole.kind.resize(more_vertices);
  whole.anchor.resize(more_vertices);
  whole.near_face.resize(more_vertices);
  whole.quads.resize(quads + patch.mesh.quads.size() - patch.quads.size());
  whole.feature_edges.resize(edges + patch.mesh.feature_edges.size() - patch.feature_edges.size());
  const auto vertex = [&](int v) { return number_of(patch.vertices, v, vertices); };
  for (std::size_t k = 0; k < patch.mesh.positions.size(); ++k) {
    const int v = vertex(static_cast<int>(k));
    whole.positions[v] = patch.mesh.positions[k];
    whole.kind[v] = patch.mesh.kind[k];
    whole.anchor[v] = patch.mesh.anchor[k];
    whole.near_face[v] = patch.mesh.near_face[k];
  }
  for (std::size_t k = 0; k < patch.mesh.quads.size(); ++k) {
    const auto& v = patch.mesh.quads[k];
    whole.quads[number_of(patch.quads, k, quads)] = {vertex(v[0]), vertex(v[1]), vertex(v[2]), vertex(v[3])};
  }
  for (std::size_t k = 0; k < patch.mesh.feature_edges.size(); ++k) {
    const QuadMesh::FeatureEdge& edge = patch.mesh.feature_edges[k];
    whole.feature_edges[number_of(patch.feature_edges, k, edges)] = {vertex(edge.a), vertex(edge.b), edge.curve};
  }
}

}  // namespace hybrid_quad
