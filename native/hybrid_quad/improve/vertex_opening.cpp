#include "hybrid_quad/improve/vertex_opening.h"

#include <algorithm>

#include "hybrid_quad/improve/quad_moves.h"

namespace hybrid_quad {

namespace {

/// The quads at v, counterclockwise; empty where they are no closed fan.
std::vector<int> fan_of(const EditMesh& mesh, int v) {
  std::vector<int> fan;
  for (int q = mesh.quads_at(v).front(); static_cast<int>(fan.size()) < mesh.valence(v);) {
    fan.push_back(q);
    q = mesh.across(q, (mesh.corner_of(q, v) + 3) & 3);
    if (q < 0) return {};
  }
  return fan;
}

int edge_end(const EditMesh& mesh, int q, int v) { return mesh.quad(q)[(mesh.corner_of(q, v) + 1) & 3]; }

double cost_inside(int valence) {
  const double difference = valence - 4;
  return difference * difference;
}

}  // namespace

std::vector<VertexOpening> openings_of(const EditMesh& mesh, int v) {
  constexpr int kLeast = 2;  // quads on either side: the new one is the third
  const int n = mesh.valence(v);
  if (n < 2 * kLeast || !mesh.is_free(v) || mesh.is_pinned(v) || mesh.on_boundary(v) || !mesh.feature_links(v).empty()) return {};
  const std::vector<int> fan = fan_of(mesh, v);
  std::vector<VertexOpening> openings;
  for (int i = 0; i < static_cast<int>(fan.size()); ++i)
    for (int j = i + kLeast; j <= std::min(i + n - kLeast, n - 1); ++j)
      openings.push_back({v, edge_end(mesh, fan[i], v), edge_end(mesh, fan[j], v), j - i});
  return openings;
}

double opening_cost(const EditMesh& mesh, const VertexOpening& opening) {
  const int n = mesh.valence(opening.vertex);
  double cost = cost_inside(opening.quads + 1) + cost_inside(n - opening.quads + 1) - cost_inside(n);
  for (const int end : {opening.first, opening.second})
    if (mesh.feature_links(end).empty()) cost += cost_inside(mesh.valence(end) + 1) - cost_inside(mesh.valence(end));
    else cost += 1;
  return cost;
}

void open_vertex(Workpiece& piece, const VertexOpening& opening) {
  constexpr double kApart = 0.25;  // of the way to what lies on either side
  EditMesh& mesh = piece.mesh;
  const int v = opening.vertex;
  const std::vector<int> fan = fan_of(mesh, v);
  const int start = static_cast<int>(
      std::find_if(fan.begin(), fan.end(), [&](int q) { return edge_end(mesh, q, v) == opening.first; }) - fan.begin());
  std::vector<int> moved;
  Vector3 kept_side = Vector3::Zero(), moved_side = Vector3::Zero();
  for (int i = 0; i < static_cast<int>(fan.size()); ++i) {
    const int q = fan[(start + i) % fan.size()];
    const Vector3& across = mesh.positions[mesh.quad(q)[(mesh.corner_of(q, v) + 2) & 3]];
    if (i < opening.quads) {
      kept_side += across / opening.quads;
    } else {
      moved_side += across / static_cast<double>(fan.size() - opening.quads);
      moved.push_back(q);
    }
  }
  const Vector3 at = mesh.positions[v];
  const int region = mesh.anchor(v);
  const int other = piece.add_vertex((1 - kApart) * at + kApart * moved_side, region, Vector3::Zero(), piece.face[v]);
  for (const int q : moved) {
    EditMesh::Quad corners = mesh.quad(q);
    corners[mesh.corner_of(q, v)] = other;
    mesh.set_quad(q, corners, true);
  }
  piece.add_quad({v, opening.second, other, opening.first}, piece.region[moved.front()]);
  const SurfacePoint point = piece.walk((1 - kApart) * at + kApart * kept_side, piece.face[v]);
  if (point.face < 0) return;
  piece.face[v] = point.face;
  mesh.positions[v] = point.position;
}

}  // namespace hybrid_quad
