#include "hybrid_quad/improve/tip_pulls.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "hybrid_quad/improve/shape_descent.h"

namespace hybrid_quad {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLeastDefect = 2.5, kMostAgreement = 0.8, kFlat = 0.95;
constexpr double kFarthest = 1.5;  ///< in edge lengths: tip from the middle of its quad
constexpr double kWeight = 30;     ///< of a pull
constexpr std::size_t kFewest = 24;  ///< quads: fewer are all tips

/// 2 pi less the angles of the quads at an inner free vertex; 0 where curves hold the vertex.
double angle_defect(const EditMesh& mesh, int v) {
  if (!mesh.is_free(v) || mesh.on_boundary(v)) return 0;
  double defect = 2 * kPi;
  for (const int q : mesh.quads_at(v)) {
    const EditMesh::Quad& corners = mesh.quad(q);
    const int k = mesh.corner_of(q, v);
    const Vector3 forth = mesh.positions[corners[(k + 1) & 3]] - mesh.positions[v];
    const Vector3 back = mesh.positions[corners[(k + 3) & 3]] - mesh.positions[v];
    defect -= std::atan2(forth.cross(back).norm(), forth.dot(back));
  }
  return defect;
}

/// How far some quads look the same way: their vector areas' sum against the sum of areas.
double agreement_of(const EditMesh& mesh, const std::vector<int>& quads) {
  Vector3 sum = Vector3::Zero();
  double size = 0;
  for (const int q : quads) {
    const EditMesh::Quad& v = mesh.quad(q);
    const Vector3 area = (mesh.positions[v[2]] - mesh.positions[v[0]]).cross(mesh.positions[v[3]] - mesh.positions[v[1]]);
    sum += area;
    size += area.norm();
  }
  return size > 0 ? sum.norm() / size : 1;
}

/// How far the input looks the same way below some vertices: 1 where its normals are all alike. Those of the quads say little where these are
/// folded still.
double agreement_below(const Workpiece& piece, const std::vector<int>& vertices) {
  Vector3 sum = Vector3::Zero();
  int count = 0;
  for (const int v : vertices) {
    if (piece.face[v] < 0) continue;
    sum += piece.input.normal(piece.face[v]);
    ++count;
  }
  return count > 0 ? sum.norm() / count : 1;
}

Vector3 middle_of(const EditMesh& mesh, const std::vector<int>& vertices) {
  Vector3 sum = Vector3::Zero();
  for (const int v : vertices) sum += mesh.positions[v];
  return sum / static_cast<double>(vertices.size());
}

/// From a face on, from vertex to vertex, as far along a direction as it goes without being too far from a point.
int climbed(const TriangleMesh& surface, int face, const Vector3& along, const Vector3& from, double farthest) {
  const auto height = [&](int v) { return along.dot(surface.position(v)); };
  const auto is_higher = [&](int a, int b) { return height(a) < height(b); };
  const auto& corners = surface.faces()[face];
  int at = *std::max_element(corners.begin(), corners.end(), is_higher);
  for (;;) {
    int highest = at, h = surface.outgoing(at);
    const int start = h;
    do {
      if (is_higher(highest, surface.to(h))) highest = surface.to(h);
      h = surface.rotate_ccw(h);
    } while (h >= 0 && h != start);
    if (highest == at || (surface.position(highest) - from).norm() > farthest) return at;
    at = highest;
  }
}

/// The input's vertex that is the tip at quad q, -1 if it is at none.
int tip_at(const Workpiece& piece, const std::vector<double>& defect, int q) {
  const EditMesh& mesh = piece.mesh;
  const std::vector<int> corners(mesh.quad(q).begin(), mesh.quad(q).end());
  const auto add = [&](double sum, int v) { return sum + defect[v]; };
  if (std::accumulate(corners.begin(), corners.end(), 0.0, add) < kLeastDefect) return -1;
  std::vector<int> around = with_ring(mesh, corners);
  if (agreement_of(mesh, quads_at(mesh, corners)) > kMostAgreement || agreement_below(piece, around) > kFlat) return -1;
  const auto on_face = std::find_if(corners.begin(), corners.end(), [&](int v) { return piece.face[v] >= 0; });
  const auto is_corner = [&](int v) { return std::find(corners.begin(), corners.end(), v) != corners.end(); };
  around.erase(std::remove_if(around.begin(), around.end(), is_corner), around.end());
  if (on_face == corners.end() || around.empty()) return -1;
  const Vector3 middle = middle_of(mesh, corners), out = middle - middle_of(mesh, around);
  const int face = piece.walk(middle, piece.face[*on_face]).face;
  return climbed(piece.input, face, out.normalized(), middle, kFarthest * std::max(piece.h, piece.edge_at(corners.front())));
}

std::vector<int> live_quads(const EditMesh& mesh) {
  std::vector<int> quads;
  for (int q = 0; q < mesh.quad_count(); ++q)
    if (mesh.alive(q)) quads.push_back(q);
  return quads;
}

}  // namespace

TipPulls::TipPulls(const Workpiece& piece, const std::vector<Vector3>& released) {
  const EditMesh& mesh = piece.mesh;
  std::vector<double> defect(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) defect[v] = mesh.valence(v) > 0 ? angle_defect(mesh, v) : 0;
  std::map<int, int> quad_of;  // quads that cover a tip together have it once
  const std::vector<int> quads = live_quads(mesh);
  if (quads.size() < kFewest) return;
  for (const int q : quads) {
    const int tip = tip_at(piece, defect, q);
    if (tip >= 0) quad_of.emplace(tip, q);
  }
  for (const auto& [v, q] : quad_of) {
    const Vector3& point = piece.input.position(v);
    if (std::find(released.begin(), released.end(), point) == released.end()) tips_.push_back({point, q});
  }
}

void TipPulls::attach(const EditMesh& mesh) {
  constexpr int kRings = 3;
  pulls_.clear();
  for (Tip& tip : tips_) {
    std::vector<int> near;
    if (mesh.alive(tip.quad)) {
      std::vector<int> vertices(mesh.quad(tip.quad).begin(), mesh.quad(tip.quad).end());
      for (int ring = 1; ring < kRings; ++ring) vertices = with_ring(mesh, vertices);
      near = quads_at(mesh, vertices);
    } else {
      near = live_quads(mesh);
    }
    const QuadSet::Place place = QuadSet(mesh, near).nearest(tip.point);
    if (place.quad < 0) continue;
    tip.quad = place.quad;
    pulls_.add(pull_of_quad(mesh, place, tip.point, kWeight));
  }
}

std::vector<Vector3> TipPulls::points() const {
  std::vector<Vector3> points;
  for (const Tip& tip : tips_) points.push_back(tip.point);
  return points;
}

}  // namespace hybrid_quad
