#include "hybrid_quad/mesh/editable_mesh.h"

#include <algorithm>
#include <utility>

namespace hybrid_quad {

EditableMesh::EditableMesh(const TriangleMesh& mesh, std::vector<int> halfedge_curve, std::vector<int> face_region)
    : positions_(mesh.positions()),
      opposite_(mesh.opposites()),
      curve_(std::move(halfedge_curve)),
      region_(std::move(face_region)) {
  origin_.resize(mesh.halfedge_count());
  for (int h = 0; h < mesh.halfedge_count(); ++h) origin_[h] = mesh.from(h);
  outgoing_.resize(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) outgoing_[v] = mesh.outgoing(v);
  if (curve_.empty()) curve_.assign(mesh.halfedge_count(), -1);
  if (region_.empty()) region_.assign(mesh.face_count(), 0);
}

void EditableMesh::glue(int h, int o, int curve) {
  opposite_[h] = o;
  curve_[h] = curve;
  if (o >= 0) {
    opposite_[o] = h;
    curve_[o] = curve;
  }
}

/// Makes the fan of from(h) start where its boundary, if any, begins. An inner vertex whose start is still one of its
/// half-edges is left as it is, which spares a walk around vertices of high valence.
void EditableMesh::update_outgoing(int h, bool may_open) {
  const int v = origin_[h], old = outgoing_[v];
  if (old >= 0 && origin_[old] == v && (opposite_[old] < 0 || !may_open)) return;
  int first = h;
  while (opposite_[first] >= 0) {
    first = next(opposite_[first]);
    if (first == h) break;
  }
  outgoing_[v] = first;
}

int EditableMesh::split_edge(int h, const Vector3& p) {
  const int o = opposite_[h], curve = curve_[h];
  const int m = vertex_slots(), b = to(h);
  positions_.push_back(p);
  outgoing_.push_back(-1);
  const auto add_face = [this](int like) {
    const int g = halfedge_slots();
    region_.push_back(region_[like]);
    origin_.resize(g + 3);
    opposite_.resize(g + 3, -1);
    curve_.resize(g + 3, -1);
    return g;
  };
  const int n0 = next(h), c = apex(h), outer_n0 = opposite_[n0], curve_n0 = curve_[n0];
  const int g0 = add_face(h / 3);
  origin_[g0] = m, origin_[g0 + 1] = b, origin_[g0 + 2] = c;
  origin_[n0] = m;
  glue(g0 + 1, outer_n0, curve_n0);
  glue(g0 + 2, n0, -1);
  glue(g0, -1, curve);
  if (o >= 0) {
    const int p1 = previous(o), d = apex(o), outer_p1 = opposite_[p1], curve_p1 = curve_[p1];
    const int g1 = add_face(o / 3);
    origin_[g1] = b, origin_[g1 + 1] = m, origin_[g1 + 2] = d;
    origin_[o] = m;
    glue(g1 + 2, outer_p1, curve_p1);
    glue(g1 + 1, p1, -1);
    glue(g1, g0, curve);
    if (outgoing_[d] == p1) outgoing_[d] = g1 + 2;
    update_outgoing(g1);
  } else {
    update_outgoing(g0 + 1);
  }
  update_outgoing(g0);
  update_outgoing(h);
  return m;
}

bool EditableMesh::are_neighbours(int v, int w) const {
  // Both fans in step: the search ends with the smaller one.
  const int start_v = outgoing_[v], start_w = outgoing_[w];
  for (int h = start_v, k = start_w;;) {
    if (to(h) == w || apex(h) == w || to(k) == v || apex(k) == v) return true;
    h = rotate_ccw(h);
    k = rotate_ccw(k);
    if (h < 0 || k < 0 || h == start_v || k == start_w) return false;
  }
}

bool EditableMesh::has_more_faces(int v, int count) const {
  int h = outgoing_[v];
  for (; count > 0; --count) {
    h = rotate_ccw(h);
    if (h < 0 || h == outgoing_[v]) return false;
  }
  return true;
}

bool EditableMesh::can_flip(int h) const {
  const int o = opposite_[h];
  if (o < 0 || curve_[h] >= 0) return false;
  const int c = apex(h), d = apex(o), a = from(h), b = to(h);
  if (c == d || a == b || c == a || c == b || d == a || d == b) return false;
  const auto keeps_enough = [this](int v) { return has_more_faces(v, is_boundary_vertex(v) ? 1 : 3); };
  return keeps_enough(a) && keeps_enough(b) && !are_neighbours(c, d);
}

void EditableMesh::flip_edge(int h) {
  const int o = opposite_[h];
  const int n0 = next(h), p0 = previous(h), n1 = next(o), p1 = previous(o);
  const int a = from(h), b = to(h), c = apex(h), d = apex(o);
  const int outer[4] = {opposite_[n0], opposite_[p0], opposite_[n1], opposite_[p1]};
  const int curve[4] = {curve_[n0], curve_[p0], curve_[n1], curve_[p1]};
  origin_[h] = d, origin_[n0] = c, origin_[p0] = a;
  origin_[o] = c, origin_[n1] = d, origin_[p1] = b;
  glue(n0, outer[1], curve[1]);
  glue(p0, outer[2], curve[2]);
  glue(n1, outer[3], curve[3]);
  glue(p1, outer[0], curve[0]);
  for (const int slot : {p0, p1, n0, n1}) update_outgoing(slot);
}

bool EditableMesh::can_collapse(int h) const {
  const int o = opposite_[h];
  const int a = from(h), b = to(h), c = apex(h), d = o >= 0 ? apex(o) : -1;
  if (a == b || c == d || c == a || c == b || d == a || d == b) return false;
  if (o >= 0 && is_boundary_vertex(a) && is_boundary_vertex(b)) return false;
  const auto has_sides = [this](int k) { return opposite_[next(k)] >= 0 || opposite_[previous(k)] >= 0; };
  if (!has_sides(h) || (o >= 0 && !has_sides(o))) return false;
  if (!is_boundary_vertex(c) && !has_more_faces(c, 3)) return false;
  if (d >= 0 && !is_boundary_vertex(d) && !has_more_faces(d, 3)) return false;

  // Each end's neighbours: only b, c, d may be seen from both.
  int common = 0, edges_ab = 0;
  const auto check = [&](int w) {
    edges_ab += w == b;
    if (w != b && w != c && w != d && are_neighbours(b, w)) ++common;
    return w;
  };
  int edges_ac = 0, edges_ad = 0;
  visit_outgoing(a, [&](int k) {
    const int w = check(to(k));
    edges_ac += w == c;
    edges_ad += w == d;
    if (opposite_[previous(k)] < 0) {
      const int last = check(apex(k));
      edges_ac += last == c;
      edges_ad += last == d;
    }
  });
  if (common > 0 || edges_ab != 1 || edges_ac != 1 || (d >= 0 && edges_ad != 1)) return false;
  int edges_bc = 0, edges_bd = 0;
  visit_outgoing(b, [&](int k) {
    edges_bc += to(k) == c;
    edges_bd += to(k) == d;
    if (opposite_[previous(k)] < 0) {
      edges_bc += apex(k) == c;
      edges_bd += apex(k) == d;
    }
  });
  return edges_bc == 1 && (d < 0 || edges_bd == 1);
}

void EditableMesh::collapse(int h) {
  const int a = from(h), b = to(h), o = opposite_[h];
  const int start = outgoing_[a];
  const bool opens = opposite_[start] < 0;
  int k = start;
  do {
    origin_[k] = b;
    k = opposite_[previous(k)];
  } while (k >= 0 && k != start);

  // The two outer sides of each face that goes become one edge between b and the face's apex.
  int touched[8], count = 0;
  for (const int side : {h, o}) {
    if (side < 0) continue;
    const int x = opposite_[next(side)], y = opposite_[previous(side)];
    const int curve = std::max(curve_[next(side)], curve_[previous(side)]);
    glue(x >= 0 ? x : y, x >= 0 ? y : -1, curve);
    for (const int z : {x, y})
      if (z >= 0) {
        touched[count++] = z;
        touched[count++] = next(z);
      }
  }
  for (const int side : {h, o})
    if (side >= 0)
      for (const int dead : {side, next(side), previous(side)})
        origin_[dead] = opposite_[dead] = -1;
  outgoing_[a] = -1;
  for (int i = 0; i < count; ++i) update_outgoing(touched[i], opens);
}

bool EditableMesh::can_take_away(int f) const {
  int open = 0, side = -1;  // the last that is boundary
  for (int h = 3 * f; h < 3 * f + 3; ++h)
    if (opposite_[h] < 0) {
      ++open;
      side = h;
    }
  // An apex at the boundary would have two fans.
  return open == 2 || (open == 1 && !is_boundary_vertex(apex(side)) && opposite_[next(side)] != previous(side));
}

void EditableMesh::take_away(int f) {
  // The fans of vertices at the boundary start there.
  for (int h = 3 * f; h < 3 * f + 3; ++h)
    if (opposite_[h] < 0 && opposite_[previous(h)] < 0) outgoing_[origin_[h]] = -1;
  for (int h = 3 * f; h < 3 * f + 3; ++h) {
    const int o = opposite_[h];
    if (o < 0) continue;
    opposite_[o] = -1;
    outgoing_[origin_[o]] = o;
  }
  for (int h = 3 * f; h < 3 * f + 3; ++h) origin_[h] = opposite_[h] = -1;
}

EditableMesh::Compacted EditableMesh::compacted() const {
  std::vector<int> vertices, faces;
  for (int v = 0; v < vertex_slots(); ++v)
    if (is_vertex(v)) vertices.push_back(v);
  for (int f = 0; f < face_slots(); ++f)
    if (is_face(f)) faces.push_back(f);
  return compacted_in_order(std::move(vertices), std::move(faces));
}

EditableMesh::Compacted EditableMesh::compacted_by_neighbourhood() const {
  std::vector<int> vertices, faces = faces_by_neighbourhood();
  std::vector<char> seen(vertex_slots(), 0);
  for (const int f : faces)
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      if (seen[origin_[h]]) continue;
      seen[origin_[h]] = 1;
      vertices.push_back(origin_[h]);
    }
  return compacted_in_order(std::move(vertices), std::move(faces));
}

std::vector<int> EditableMesh::faces_by_neighbourhood() const {
  std::vector<int> order;
  std::vector<char> seen(face_slots(), 0);
  const auto reach = [&](int f) {
    if (seen[f]) return;
    seen[f] = 1;
    order.push_back(f);
  };
  std::size_t done = 0;
  for (int seed = 0; seed < face_slots(); ++seed) {
    if (is_face(seed)) reach(seed);
    for (; done < order.size(); ++done)
      for (int h = 3 * order[done]; h < 3 * order[done] + 3; ++h)
        if (opposite_[h] >= 0) reach(opposite_[h] / 3);
  }
  return order;
}

EditableMesh::Compacted EditableMesh::compacted_in_order(std::vector<int> vertices, std::vector<int> slots) const {
  Compacted result;
  result.vertex_slot = std::move(vertices);
  result.face_slot = std::move(slots);
  std::vector<int> new_vertex(vertex_slots(), -1), new_face(face_slots(), -1);
  std::vector<Vector3> positions;
  for (const int v : result.vertex_slot) {
    new_vertex[v] = static_cast<int>(positions.size());
    positions.push_back(positions_[v]);
  }
  std::vector<std::array<int, 3>> faces;
  for (const int f : result.face_slot) {
    new_face[f] = static_cast<int>(faces.size());
    faces.push_back({new_vertex[origin_[3 * f]], new_vertex[origin_[3 * f + 1]], new_vertex[origin_[3 * f + 2]]});
    result.face_region.push_back(region_[f]);
  }
  std::vector<int> opposite;
  opposite.reserve(3 * faces.size());
  for (const int f : result.face_slot)
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      opposite.push_back(opposite_[h] < 0 ? -1 : 3 * new_face[opposite_[h] / 3] + opposite_[h] % 3);
      result.halfedge_curve.push_back(curve_[h]);
    }
  result.mesh = TriangleMesh(std::move(positions), std::move(faces), std::move(opposite));
  return result;
}

}  // namespace hybrid_quad
