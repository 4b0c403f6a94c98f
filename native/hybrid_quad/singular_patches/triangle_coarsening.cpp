#include "hybrid_quad/singular_patches/triangle_coarsening.h"

#include <algorithm>
#include <queue>
#include <tuple>

namespace hybrid_quad {

namespace {
constexpr auto next = TriangleMesh::next;
constexpr auto previous = TriangleMesh::previous;

constexpr double kLeastCosine = 0.3;  // between a face and the surface at its corners
constexpr double kNoArea = 1e-3;      // twice a face's area, relative to its longest side squared

Vector3 area_normal(const Vector3& a, const Vector3& b, const Vector3& c) { return (b - a).cross(c - a); }
}  // namespace

CoarseTriangles::CoarseTriangles(const PatchSurface& patch, const PatchBorder& border) {
  const TriangleMesh& mesh = patch.mesh;
  positions_ = mesh.positions();
  for (const auto& t : mesh.faces()) vertex_.insert(vertex_.end(), t.begin(), t.end());
  opposite_ = mesh.opposites();
  passed_.assign(vertex_.size(), -1);
  alive_.assign(mesh.face_count(), 1);
  faces_at_.assign(positions_.size(), 0);
  for (const int v : vertex_) ++faces_at_[v];
  border_vertex_.assign(positions_.size(), -1);
  normals_.assign(positions_.size(), Vector3::Zero());
  for (int f = 0; f < mesh.face_count(); ++f)
    for (const int v : mesh.face(f)) normals_[v] += mesh.area_normal(f);
  for (Vector3& n : normals_) n.normalize();
  for (const auto& loop : border) add_collar(patch, loop);
}

int CoarseTriangles::add_face(int a, int b, int c) {
  const int h = static_cast<int>(vertex_.size());
  for (const int v : {a, b, c}) {
    vertex_.push_back(v);
    opposite_.push_back(-1);
    passed_.push_back(-1);
    ++faces_at_[v];
  }
  alive_.push_back(1);
  return h;
}

void CoarseTriangles::glue(int g, int h) {
  opposite_[g] = h;
  if (h >= 0) opposite_[h] = g;
}

namespace {

/// How far the nodes after arcs first, first + 2, ... reach across the line between their neighbours, into
/// the patch above all.
double bend_of(const TriangleMesh& mesh, const std::vector<Vector3>& normals,
               const std::vector<PatchArc>& loop, int first) {
  double bend = 0;
  const int arcs = static_cast<int>(loop.size());
  for (int k = first; k < arcs + first; k += 2) {
    const PatchArc &arc = loop[k % arcs], &after = loop[(k + 1) % arcs];
    const Vector3 line = mesh.position(after.to) - mesh.position(arc.from);
    const Vector3 off = mesh.position(arc.to) - 0.5 * (mesh.position(after.to) + mesh.position(arc.from));
    const bool inwards = normals[arc.to].cross(line).dot(off) > 0;
    bend += (inwards ? 4 : 1) * off.squaredNorm();
  }
  return bend;
}

}  // namespace

void CoarseTriangles::add_collar(const PatchSurface& patch, const std::vector<PatchArc>& loop) {
  const TriangleMesh& mesh = patch.mesh;
  const int arcs = static_cast<int>(loop.size()), outer = static_cast<int>(positions_.size());
  const int first = bend_of(mesh, normals_, loop, 0) <= bend_of(mesh, normals_, loop, 1) ? 0 : 1;
  for (int k = 0; k < arcs; k += 2) {
    const int node = loop[(first + k) % arcs].from;
    positions_.push_back(mesh.position(node));
    normals_.push_back(Vector3(normals_[node]));
    border_vertex_.push_back(node);
    faces_at_.push_back(0);
  }
  int last = -1, opening = -1;  // sides along which the next face and the very first one are glued
  const auto attach = [&](int side_before, int side_after) {
    if (last >= 0)
      glue(last, side_before);
    else
      opening = side_before;
    last = side_after;
  };
  for (int k = 0; k < arcs; k += 2) {
    const int here = outer + k / 2, there = outer + (k / 2 + 1) % (arcs / 2);
    const PatchArc &before = loop[(first + k) % arcs], &after = loop[(first + k + 1) % arcs];
    const auto join_to = [&](const PatchArc& arc, int corner) {
      for (const int h : arc.halfedges) {
        const int f = add_face(mesh.to(h), mesh.from(h), corner);
        glue(f, h);
        attach(f + 1, f + 2);
      }
    };
    join_to(before, here);
    const int f = add_face(here, there, after.from);
    passed_[f] = static_cast<int>(passed_nodes_.size());
    passed_nodes_.push_back({after.from, before.id, after.id});
    attach(f + 2, f + 1);
    join_to(after, there);
  }
  glue(last, opening);
}

void CoarseTriangles::fan(int h, std::vector<int>& out) const {
  out.clear();
  int g = h;
  do {
    out.push_back(g);
    g = opposite_[previous(g)];
  } while (g >= 0 && g != h);
}

/// Whether from(h), an inner vertex, may be drawn into to(h).
bool CoarseTriangles::can_collapse(int h) {
  const int o = opposite_[h];
  if (o < 0 || on_border(from(h))) return false;
  const int u = from(h), v = to(h), f = h / 3, g = o / 3;
  if (u == v || f == g) return false;
  for (const int side : {next(h), previous(h), next(o), previous(o)}) {
    const int beyond = opposite_[side];
    if (beyond >= 0 && (beyond / 3 == f || beyond / 3 == g)) return false;
  }
  const int a = from(previous(h)), b = from(previous(o));
  const auto enough = [&](int w, int faces) { return faces >= (on_border(w) ? 1 : 3); };
  const int lost = a == b ? 2 : 1;
  if (!enough(a, faces_at_[a] - lost) || !enough(b, faces_at_[b] - lost)) return false;
  if (!enough(v, faces_at_[u] + faces_at_[v] - 4)) return false;
  fan(h, fan_);
  int joined = 0;
  for (const int e : fan_) joined += to(e) == v;
  return joined == 1;  // another edge between them would become a loop
}

bool CoarseTriangles::faces_outwards(const std::array<int, 3>& corners,
                                     const std::array<Vector3, 3>& p) const {
  const Vector3 normal = area_normal(p[0], p[1], p[2]);
  const double area = normal.norm();
  const double longest =
      std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
  if (!(area > kNoArea * longest)) return true;
  for (const int v : corners)
    if (normal.dot(normals_[v]) < kLeastCosine * area) return false;
  return true;
}

/// No face turns away from the surface and no edge gets too long.
bool CoarseTriangles::keeps_shape(int h, double longest) {
  const Vector3 goal = positions_[to(h)];
  const bool first_step = !(edge_length(h) > 0);  // out of the collar
  fan(h, fan_);
  for (std::size_t i = 1; i < fan_.size(); ++i) {
    const int q = to(fan_[i]), r = from(previous(fan_[i]));
    if (!first_step && (positions_[q] - goal).norm() > longest) return false;
    if (i + 1 == fan_.size()) continue;  // goes with the edge
    if (!faces_outwards({to(h), q, r}, {goal, positions_[q], positions_[r]})) return false;
  }
  return true;
}

void CoarseTriangles::collapse(int h, std::vector<int>& touched) {
  const int o = opposite_[h], u = from(h), v = to(h);
  fan(h, fan_);
  for (const int e : fan_) vertex_[e] = v;
  faces_at_[v] += faces_at_[u];
  faces_at_[u] = 0;
  touched = fan_;
  for (const int side : {h, o}) {
    for (int i = 0; i < 3; ++i) --faces_at_[vertex_[3 * (side / 3) + i]];
    alive_[side / 3] = 0;
    const int x = opposite_[next(side)], y = opposite_[previous(side)];
    const int below = std::max(passed_[next(side)], passed_[previous(side)]);
    for (const auto& [e, beyond] : {std::make_pair(x, y), std::make_pair(y, x)}) {
      if (e < 0) continue;
      opposite_[e] = beyond;
      if (beyond < 0) passed_[e] = below;
    }
  }
}

void CoarseTriangles::coarsen(double length, bool keep_shape, const RunContext& context) {
  using Entry = std::tuple<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  std::vector<double> queued_length(vertex_.size(), -1);  // of each side that waits in the queue
  const auto push = [&](int h) {
    const double l = edge_length(h);
    if (!(l < length) || queued_length[h] == l) return;
    queued_length[h] = l;
    queue.emplace(l, h);
  };
  for (int h = 0; h < static_cast<int>(vertex_.size()); ++h) push(h);
  std::vector<int> touched;
  for (int steps = 0; !queue.empty(); ++steps) {
    if (steps % 4096 == 0) context.checkpoint();
    const auto [expected, h] = queue.top();
    queue.pop();
    if (queued_length[h] != expected) continue;
    queued_length[h] = -1;
    if (!alive_[h / 3] || edge_length(h) != expected || !can_collapse(h)) continue;
    if (keep_shape && !keeps_shape(h, 2 * length)) continue;
    collapse(h, touched);
    for (const int e : touched)
      if (alive_[e / 3]) {
        push(e);
        push(previous(e));
        push(next(e));
      }
  }
}

bool CoarseTriangles::can_flip(int h) const {
  const int o = opposite_[h];
  if (o < 0 || o / 3 == h / 3) return false;
  const int a = from(h), b = to(h), c = from(previous(h)), d = from(previous(o));
  if (c == d) return false;
  const auto enough = [&](int v) { return faces_at_[v] - 1 >= (on_border(v) ? 1 : 3); };
  if (!enough(a) || !enough(b)) return false;
  const auto off = [&](int v, int change) {
    const int x = faces_at_[v] + change - (on_border(v) ? 3 : 6);
    return x * x;
  };
  if (off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1) >= off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0))
    return false;
  const Vector3 &pa = positions_[a], &pb = positions_[b], &pc = positions_[c], &pd = positions_[d];
  const Vector3 old = area_normal(pa, pb, pc) + area_normal(pb, pa, pd);
  const double least = 0.1 * old.squaredNorm();
  return area_normal(pc, pa, pd).dot(old) > least && area_normal(pd, pb, pc).dot(old) > least &&
         faces_outwards({c, a, d}, {pc, pa, pd}) && faces_outwards({d, b, c}, {pd, pb, pc});
}

void CoarseTriangles::flip(int h) {
  const int o = opposite_[h], a = from(h), b = to(h), c = from(previous(h)), d = from(previous(o));
  const int h1 = next(h), h2 = previous(h), o1 = next(o), o2 = previous(o);
  // (a, b, c), (b, a, d) become (d, c, a), (c, d, b): sides h, o turn; two outer sides change faces.
  const int bc = opposite_[h1], ca = opposite_[h2], ad = opposite_[o1], db = opposite_[o2];
  const int bc_below = passed_[h1], ca_below = passed_[h2], ad_below = passed_[o1], db_below = passed_[o2];
  vertex_[h] = d, vertex_[h1] = c, vertex_[h2] = a;
  vertex_[o] = c, vertex_[o1] = d, vertex_[o2] = b;
  // A side of one of the two faces may be glued to another side of them: name it by its new place.
  const auto moved = [&](int e) { return e == h1 ? o2 : e == h2 ? h1 : e == o1 ? h2 : e == o2 ? o1 : e; };
  const int new_ca = moved(ca), new_ad = moved(ad), new_db = moved(db), new_bc = moved(bc);
  for (const auto& [side, beyond, below] :
       {std::make_tuple(h1, new_ca, ca_below), std::make_tuple(h2, new_ad, ad_below),
        std::make_tuple(o1, new_db, db_below), std::make_tuple(o2, new_bc, bc_below)}) {
    glue(side, beyond);
    passed_[side] = below;
  }
  --faces_at_[a], --faces_at_[b], ++faces_at_[c], ++faces_at_[d];
}

void CoarseTriangles::flip_towards_six() {
  for (int sweep = 0; sweep < 4; ++sweep) {
    bool changed = false;
    for (int h = 0; h < static_cast<int>(vertex_.size()); ++h)
      if (alive_[h / 3] && h < opposite_[h] && can_flip(h)) {
        flip(h);
        changed = true;
      }
    if (!changed) return;
  }
}

void CoarseTriangles::smooth(const SurfaceIndex& surface, int sweeps) {
  std::vector<int> outgoing(positions_.size(), -1);
  for (int h = 0; h < static_cast<int>(vertex_.size()); ++h)
    if (alive_[h / 3]) outgoing[from(h)] = h;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int v = 0; v < static_cast<int>(positions_.size()); ++v) {
      if (outgoing[v] < 0 || on_border(v)) continue;
      fan(outgoing[v], fan_);
      Vector3 mean = Vector3::Zero();
      for (const int h : fan_) mean += positions_[to(h)] / static_cast<double>(fan_.size());
      const SurfacePoint goal = surface.nearest(mean);
      const Vector3 old_normal = normals_[v];
      normals_[v] = surface.mesh().normal(goal.face);
      bool allowed = true;
      for (const int h : fan_) {
        const int q = to(h), r = from(previous(h));
        allowed = allowed && faces_outwards({v, q, r}, {goal.position, positions_[q], positions_[r]});
      }
      if (allowed)
        positions_[v] = goal.position;
      else
        normals_[v] = old_normal;
    }
}

void CoarseTriangles::raise_low_valences() {
  for (int h = 0; h < static_cast<int>(vertex_.size()); ++h) {
    if (!alive_[h / 3] || on_border(from(h)) || faces_at_[from(h)] >= 3) continue;
    const int f = 3 * (h / 3);  // cut into three at its middle
    const int center = static_cast<int>(positions_.size());
    const std::array<int, 3> v{vertex_[f], vertex_[f + 1], vertex_[f + 2]};
    const Vector3 middle = (positions_[v[0]] + positions_[v[1]] + positions_[v[2]]) / 3.0;
    positions_.push_back(middle);
    normals_.push_back(Vector3(normals_[v[0]]));
    border_vertex_.push_back(-1);
    faces_at_.push_back(1);
    vertex_[f + 2] = center;
    --faces_at_[v[2]];
    const int g = add_face(v[1], v[2], center), k = add_face(v[2], v[0], center);
    for (const auto& [from_side, to_side] : {std::make_pair(f + 1, g), std::make_pair(f + 2, k)}) {
      const int beyond = opposite_[from_side];
      passed_[to_side] = passed_[from_side];
      passed_[from_side] = -1;
      glue(to_side, beyond == f + 1 ? g : beyond == f + 2 ? k : beyond);
    }
    glue(f + 1, g + 2);
    glue(g + 1, k + 2);
    glue(k + 1, f + 2);
  }
}

void CoarseTriangles::compact() {
  std::vector<int> new_face(alive_.size(), -1), new_vertex(positions_.size(), -1);
  int faces = 0, vertices = 0;
  for (std::size_t f = 0; f < alive_.size(); ++f)
    if (alive_[f]) new_face[f] = faces++;
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    if (faces_at_[v] == 0) continue;
    new_vertex[v] = vertices++;
    positions_[new_vertex[v]] = Vector3(positions_[v]);
    normals_[new_vertex[v]] = Vector3(normals_[v]);
    border_vertex_[new_vertex[v]] = border_vertex_[v];
    faces_at_[new_vertex[v]] = faces_at_[v];
  }
  for (std::size_t h = 0; h < vertex_.size(); ++h) {
    if (!alive_[h / 3]) continue;
    const int n = 3 * new_face[h / 3] + static_cast<int>(h % 3), o = opposite_[h];
    vertex_[n] = new_vertex[vertex_[h]];
    opposite_[n] = o < 0 ? -1 : 3 * new_face[o / 3] + o % 3;
    passed_[n] = passed_[h];
  }
  for (std::vector<int>* sides : {&vertex_, &opposite_, &passed_}) sides->resize(3 * faces);
  positions_.resize(vertices);
  normals_.resize(vertices);
  border_vertex_.resize(vertices);
  faces_at_.resize(vertices);
  alive_.assign(faces, 1);
}

}  // namespace hybrid_quad
