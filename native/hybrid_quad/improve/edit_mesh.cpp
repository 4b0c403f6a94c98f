#include "hybrid_quad/improve/edit_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hybrid_quad {

EditMesh::EditMesh(const QuadMesh& mesh, const TriangleMesh& input, const FeatureGraph& features)
    : positions(mesh.positions),
      quads_(mesh.quads),
      alive_(mesh.quads.size(), 1),
      locked_(mesh.quads.size(), 0),
      pinned_(mesh.positions.size(), 0),
      incident_(mesh.positions.size()),
      kind_(mesh.kind),
      anchor_(mesh.anchor),
      boundary_(mesh.positions.size(), 0),
      links_(mesh.positions.size()),
      feature_edges_(mesh.feature_edges) {
  for (int q = 0; q < quad_count(); ++q)
    for (const int v : quads_[q]) incident_[v].push_back(q);
  find_boundary();
  link_features(feature_edges_);
  find_ideals(input, features);
}

void EditMesh::find_boundary() {
  for (int q = 0; q < quad_count(); ++q)
    for (int i = 0; i < 4; ++i)
      if (across(q, i) < 0) boundary_[quads_[q][i]] = boundary_[quads_[q][(i + 1) % 4]] = 1;
}

void EditMesh::link_features(const std::vector<QuadMesh::FeatureEdge>& edges) {
  for (const QuadMesh::FeatureEdge& e : edges) {
    links_[e.a].push_back({e.b, e.curve, true});
    links_[e.b].push_back({e.a, e.curve, false});
  }
}

void EditMesh::find_ideals(const TriangleMesh& input, const FeatureGraph& features) {
  constexpr double kRightAngle = M_PI / 2;
  for (int v = 0; v < vertex_count(); ++v) {
    if (kind_[v] != VertexKind::kCorner) {
      for (FeatureLink& link : links_[v]) link.angle = M_PI;
      continue;
    }
    if (anchor_[v] < 0 || anchor_[v] >= input.vertex_count()) continue;
    for (FeatureLink& link : links_[v]) {
      if (link.curve < 0 || link.curve >= static_cast<int>(features.curves.size())) continue;
      const std::vector<int>& along = features.curves[link.curve].vertices;
      const int next = link.forward ? along[1] : along[along.size() - 2];
      int h = input.outgoing(anchor_[v]);
      int left = input.halfedge_count();
      while (h >= 0 && input.to(h) != next && --left > 0) {
        h = input.rotate_ccw(h);
        if (h == input.outgoing(anchor_[v])) h = -1;
      }
      double angle = 0;
      while (h >= 0 && --left > 0) {
        const Vector3 a = input.edge_vector(h), b = -input.edge_vector(TriangleMesh::previous(h));
        angle += std::atan2(a.cross(b).norm(), a.dot(b));
        h = input.rotate_ccw(h);
        if (h >= 0 && features.is_feature(h)) break;
      }
      if (!(angle > 0)) continue;
      link.angle = angle;
      link.ideal = std::max(1, static_cast<int>(std::lround(angle / kRightAngle)));
    }
  }
}

QuadMesh EditMesh::extract(const std::vector<int>& near_face) const {
  QuadMesh mesh;
  std::vector<int> fresh(positions.size(), -1);
  for (int v = 0; v < vertex_count(); ++v) {
    if (incident_[v].empty()) continue;
    fresh[v] = static_cast<int>(mesh.positions.size());
    mesh.positions.push_back(positions[v]);
    mesh.kind.push_back(kind_[v]);
    mesh.anchor.push_back(anchor_[v]);
    mesh.near_face.push_back(near_face.empty() ? -1 : near_face[v]);
  }
  for (int q = 0; q < quad_count(); ++q)
    if (alive_[q]) mesh.quads.push_back({fresh[quads_[q][0]], fresh[quads_[q][1]], fresh[quads_[q][2]], fresh[quads_[q][3]]});
  for (const QuadMesh::FeatureEdge& e : feature_edges_) mesh.feature_edges.push_back({fresh[e.a], fresh[e.b], e.curve});
  return mesh;
}

bool EditMesh::is_feature(int a, int b) const {
  if (links_[b].size() < links_[a].size()) std::swap(a, b);
  for (const FeatureLink& link : links_[a])
    if (link.vertex == b) return true;
  return false;
}

int EditMesh::corner_of(int q, int v) const {
  for (int i = 0; i < 4; ++i)
    if (quads_[q][i] == v) return i;
  return -1;
}

int EditMesh::across(int q, int side) const {
  const int a = quads_[q][side], b = quads_[q][(side + 1) & 3];
  const int with_fewer = incident_[b].size() < incident_[a].size() ? b : a;
  for (const int other : incident_[with_fewer]) {
    const int i = corner_of(other, b);
    if (other != q && i >= 0 && quads_[other][(i + 1) & 3] == a) return other;
  }
  return -1;
}

bool EditMesh::has_edge(int a, int b) const {
  for (const int q : incident_[a]) {
    const int i = corner_of(q, a);
    if (quads_[q][(i + 1) & 3] == b || quads_[q][(i + 3) & 3] == b) return true;
  }
  return false;
}

int EditMesh::least_valence(int v) const {
  if (!boundary_[v]) return 3;
  return kind_[v] == VertexKind::kCorner ? 1 : 2;
}

void EditMesh::lock(int q) {
  locked_[q] = 1;
  for (const int v : quads_[q]) pinned_[v] = 1;
}

void EditMesh::set_quad(int q, const Quad& corners, bool is_alive) {
  log_.push_back({q, quads_[q], alive_[q]});
  replace(q, corners, is_alive);
}

void EditMesh::replace(int q, const Quad& corners, bool is_alive) {
  if (alive_[q])
    for (const int v : quads_[q]) {
      auto& list = incident_[v];
      list.erase(std::lower_bound(list.begin(), list.end(), q));
    }
  quads_[q] = corners;
  alive_[q] = is_alive;
  if (is_alive)
    for (const int v : corners) {
      auto& list = incident_[v];
      list.insert(std::lower_bound(list.begin(), list.end(), q), q);
    }
}

int EditMesh::add_vertex(const Vector3& position, int region) {
  positions.push_back(position);
  incident_.emplace_back();
  kind_.push_back(VertexKind::kFree);
  anchor_.push_back(region);
  boundary_.push_back(0);
  pinned_.push_back(0);
  links_.emplace_back();
  return vertex_count() - 1;
}

int EditMesh::add_quad(const Quad& corners) {
  quads_.push_back(corners);
  alive_.push_back(0);
  locked_.push_back(0);
  set_quad(quad_count() - 1, corners, true);
  return quad_count() - 1;
}

void EditMesh::undo_to(std::size_t mark) {
  while (log_.size() > mark) {
    const Change change = log_.back();
    log_.pop_back();
    replace(change.quad, change.corners, change.alive != 0);
  }
}

}  // namespace hybrid_quad
