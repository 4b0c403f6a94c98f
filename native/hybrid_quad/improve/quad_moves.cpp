#include "hybrid_quad/improve/quad_moves.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace hybrid_quad {

namespace {

constexpr double kStraight = 140 * M_PI / 180;

/// So many quads more in the sector of `quad` at a vertex.
struct SectorChange {
  int quad = -1, quads = 0;
};

/// Quads of the sector that begins at the feature edge to `start`, counterclockwise; 0 where no quad is there.
int sector_size(const EditMesh& mesh, int v, int start, SectorChange change = {}) {
  int q = -1;
  // From the end with fewer quads: many features can meet in a vertex, and its sectors are asked for one by one.
  for (const int other : mesh.quads_at(mesh.valence(start) < mesh.valence(v) ? start : v)) {
    const int corner = mesh.corner_of(other, v);
    if (corner >= 0 && mesh.quad(other)[(corner + 1) & 3] == start) q = other;
  }
  int count = 0;
  for (int left = mesh.valence(v); q >= 0 && left > 0; --left) {
    count += q == change.quad ? 1 + change.quads : 1;
    const int side = (mesh.corner_of(q, v) + 3) & 3;
    if (mesh.is_feature(v, mesh.quad(q)[side])) break;
    q = mesh.across(q, side);
  }
  return count;
}

bool is_removable(const EditMesh& mesh, int v) {
  return mesh.is_free(v) && !mesh.on_boundary(v) && mesh.feature_links(v).empty();
}

bool neighbours(const EditMesh& mesh, int v, int w) { return v == w || mesh.has_edge(v, w); }

/// Of a vertex v with three quads that is to go with the diagonal beside it: the end of its third edge.
int third_end(const EditMesh& mesh, const EditMesh::Quad& corners, int v) {
  for (const int q : mesh.quads_at(v)) {
    const int w = mesh.quad(q)[(mesh.corner_of(q, v) + 1) & 3];
    if (std::find(corners.begin(), corners.end(), w) == corners.end()) return w;
  }
  return -1;
}

bool may_merge(const EditMesh& mesh, const EditMesh::Quad& corners, const std::vector<int>& away, int kept, int gone,
               Changed* changed) {
  if (away.empty()) return false;
  const int merged = static_cast<int>(away.size());
  if (mesh.valence(kept) + mesh.valence(gone) - 2 - merged < mesh.least_valence(kept)) return false;
  std::array<int, 2> ends{-1, -1};
  for (int i = 0; i < merged; ++i) {
    const int end = ends[i] = third_end(mesh, corners, away[i]);
    // Both quads that become one lie between the end and the diagonal: they must have other corners besides.
    std::vector<int> others;
    for (const int q : mesh.quads_at(away[i])) others.push_back(mesh.quad(q)[(mesh.corner_of(q, away[i]) + 2) & 3]);
    std::sort(others.begin(), others.end());
    if (end < 0 || std::adjacent_find(others.begin(), others.end()) != others.end()) return false;
    const int lost = i == 1 && ends[0] == end ? 2 : 1;
    if (mesh.valence(end) - lost < mesh.least_valence(end)) return false;
    changed->vertex[4 + i] = lost == 2 ? -1 : end;
  }
  return true;
}

bool may_collapse(const EditMesh& mesh, const Move& move, Changed* changed) {
  int kept, gone;
  if (!collapse_ends(mesh, move, &kept, &gone) || mesh.is_pinned(gone)) return false;
  const auto& corners = mesh.quad(move.quad);
  const int a = corners[(move.corner + 1) & 3], b = corners[(move.corner + 3) & 3];
  const std::vector<int> away = merged_away(mesh, move);
  for (const int v : {a, b})
    if (mesh.valence(v) <= mesh.least_valence(v) && std::find(away.begin(), away.end(), v) == away.end()) return false;
  if (move.kind == Move::kCollapseAndMerge && !may_merge(mesh, corners, away, kept, gone, changed)) return false;
  if (mesh.is_free(kept) && mesh.anchor(kept) != mesh.anchor(gone)) return false;
  for (const int q : mesh.quads_at(gone)) {
    if (q != move.quad && mesh.corner_of(q, kept) >= 0) return false;
    const int i = mesh.corner_of(q, gone);
    for (const int w : {mesh.quad(q)[(i + 1) & 3], mesh.quad(q)[(i + 3) & 3]})
      if (w != a && w != b && neighbours(mesh, w, kept)) return false;
  }
  std::copy_n(std::array<int, 4>{kept, gone, a, b}.begin(), 4, changed->vertex.begin());
  return true;
}

/// The two quads at v become one.
void merge_quads_at(EditMesh& mesh, int v) {
  const std::vector<int> both = mesh.quads_at(v);
  EditMesh::Quad corners = mesh.quad(both[0]);
  corners[mesh.corner_of(both[0], v)] = mesh.quad(both[1])[(mesh.corner_of(both[1], v) + 2) & 3];
  mesh.set_quad(both[1], mesh.quad(both[1]), false);
  mesh.set_quad(both[0], corners, true);
}

void collapse(EditMesh& mesh, const Move& move) {
  int kept, gone;
  collapse_ends(mesh, move, &kept, &gone);
  const std::vector<int> away = merged_away(mesh, move);
  const std::vector<int> around = mesh.quads_at(gone);
  mesh.set_quad(move.quad, mesh.quad(move.quad), false);
  for (const int q : around) {
    if (q == move.quad) continue;
    EditMesh::Quad corners = mesh.quad(q);
    corners[mesh.corner_of(q, gone)] = kept;
    mesh.set_quad(q, corners, true);
  }
  for (const int v : away) merge_quads_at(mesh, v);
}

bool may_rotate(const EditMesh& mesh, const Move& move, Changed* changed) {
  const auto& q = mesh.quad(move.quad);
  const int b = q[move.corner], c = q[(move.corner + 1) & 3];
  if (mesh.valence(b) <= mesh.least_valence(b) || mesh.valence(c) <= mesh.least_valence(c)) return false;
  if (mesh.is_feature(b, c)) return false;
  Hexagon hexagon;
  if (!hexagon_of(mesh, move, &hexagon)) return false;
  if (mesh.is_locked(move.quad) || mesh.is_locked(hexagon.other)) return false;
  const int from = move.kind == Move::kRotateBack ? hexagon.a : hexagon.x;
  const int to = move.kind == Move::kRotateBack ? hexagon.y : hexagon.d;
  if (neighbours(mesh, from, to)) return false;
  changed->vertex = {b, c, from, to, -1, -1};
  return true;
}

void rotate(EditMesh& mesh, const Move& move) {
  Hexagon h;
  hexagon_of(mesh, move, &h);
  const bool backwards = move.kind == Move::kRotateBack;
  const EditMesh::Quad first = backwards ? EditMesh::Quad{h.a, h.b, h.x, h.y} : EditMesh::Quad{h.x, h.y, h.c, h.d};
  const EditMesh::Quad second = backwards ? EditMesh::Quad{h.a, h.y, h.c, h.d} : EditMesh::Quad{h.x, h.d, h.a, h.b};
  mesh.set_quad(move.quad, first, true);
  mesh.set_quad(h.other, second, true);
}

double valence_cost(const EditMesh& mesh, int v, SectorChange change) {
  const int n = mesh.valence(v) + change.quads;
  if (n == 0) return 0;
  if (mesh.feature_links(v).empty()) {
    const double difference = n - 4;
    return difference * difference + (n < 3 ? 20 : 0) + (n > 5 ? 2 * (n - 5) : 0);
  }
  double cost = 0;
  for (const EditMesh::FeatureLink& link : mesh.feature_links(v)) {
    const int size = sector_size(mesh, v, link.vertex, change);
    if (size == 0) continue;
    const double difference = size - link.ideal;
    cost += difference * difference;
    if (link.angle > kStraight * size) cost += 20;
  }
  return cost;
}

/// What a collapse or a rotation changes at each vertex of `changed` lies in one sector, that of a quad it replaces there.
std::array<SectorChange, 4> sector_changes(const EditMesh& mesh, const Move& move, const Changed& changed) {
  if (move.kind == Move::kCollapse) {
    const int gone = mesh.valence(changed.vertex[1]);
    return {{{move.quad, gone - 2}, {move.quad, -gone}, {move.quad, -1}, {move.quad, -1}}};
  }
  const int other = mesh.across(move.quad, move.corner);
  const auto quad_at = [&](int v) { return mesh.corner_of(move.quad, v) >= 0 ? move.quad : other; };
  return {{{move.quad, -1}, {move.quad, -1}, {quad_at(changed.vertex[2]), 1}, {quad_at(changed.vertex[3]), 1}}};
}

double cost_of_merge(EditMesh& mesh, const Move& move, const Changed& changed) {
  const auto cost = [&] {
    double sum = 0;
    for (const int v : changed.vertex)
      if (v >= 0) sum += valence_cost(mesh, v, {});
    return sum;
  };
  const double before = cost();
  const std::size_t mark = mesh.mark();
  make_move(mesh, move);
  const double after = cost();
  mesh.undo_to(mark);
  return after - before;
}

}  // namespace

double valence_cost(const EditMesh& mesh, int v) { return valence_cost(mesh, v, {}); }

bool has_straight_corner(const EditMesh& mesh, int v) {
  if (mesh.valence(v) == 0) return false;
  if (mesh.feature_links(v).empty()) return mesh.valence(v) < 3;
  for (const EditMesh::FeatureLink& link : mesh.feature_links(v)) {
    const int size = sector_size(mesh, v, link.vertex);
    if (size > 0 && link.angle > kStraight * size) return true;
  }
  return false;
}

bool collapse_ends(const EditMesh& mesh, const Move& move, int* kept, int* gone) {
  const auto& q = mesh.quad(move.quad);
  *kept = q[move.corner];
  *gone = q[(move.corner + 2) & 3];
  if (!is_removable(mesh, *gone)) std::swap(*kept, *gone);
  return is_removable(mesh, *gone);
}

std::vector<int> merged_away(const EditMesh& mesh, const Move& move) {
  std::vector<int> away;
  if (move.kind != Move::kCollapseAndMerge) return away;
  for (const int side : {1, 3}) {
    const int v = mesh.quad(move.quad)[(move.corner + side) & 3];
    if (is_removable(mesh, v) && !mesh.is_pinned(v) && mesh.valence(v) == mesh.least_valence(v)) away.push_back(v);
  }
  return away;
}

bool hexagon_of(const EditMesh& mesh, const Move& move, Hexagon* hexagon) {
  const auto& q = mesh.quad(move.quad);
  const int other = mesh.across(move.quad, move.corner);
  if (other < 0) return false;
  const int b = q[move.corner], c = q[(move.corner + 1) & 3];
  const int k = mesh.corner_of(other, c);
  const auto& o = mesh.quad(other);
  *hexagon = {q[(move.corner + 3) & 3], b, o[(k + 2) & 3], o[(k + 3) & 3], c, q[(move.corner + 2) & 3], other};
  return true;
}

bool may_move(const EditMesh& mesh, const Move& move, Changed* changed) {
  if (!mesh.alive(move.quad)) return false;
  return move.collapses() ? may_collapse(mesh, move, changed) : may_rotate(mesh, move, changed);
}

void make_move(EditMesh& mesh, const Move& move) {
  if (move.collapses())
    collapse(mesh, move);
  else
    rotate(mesh, move);
}

double cost_of_move(EditMesh& mesh, const Move& move, const Changed& changed) {
  if (move.kind == Move::kCollapseAndMerge) return cost_of_merge(mesh, move, changed);
  const std::array<SectorChange, 4> changes = sector_changes(mesh, move, changed);
  double more = 0;
  for (int i = 0; i < 4; ++i) more += valence_cost(mesh, changed.vertex[i], changes[i]) - valence_cost(mesh, changed.vertex[i], {});
  return more;
}

}  // namespace hybrid_quad
