#include "hybrid_quad/improve/side_splitting.h"

#include <algorithm>
#include <utility>

namespace hybrid_quad {

namespace {

/// Quads that a fill puts at the first and at the second new vertex of the side.
std::array<int, 2> quads_at_new_vertices(HexagonFill fill) {
  switch (fill) {
    case HexagonFill::kFirstEdge:
    case HexagonFill::kStarAtSecond: return {2, 1};
    case HexagonFill::kSecondEdge:
    case HexagonFill::kStarAtFirst: return {1, 2};
    case HexagonFill::kInset: break;
  }
  return {2, 2};
}

int add_vertex(QuadMesh& mesh, const Vector3& position, VertexKind kind, int anchor, int near_face) {
  mesh.positions.push_back(position);
  mesh.kind.push_back(kind);
  mesh.anchor.push_back(anchor);
  mesh.near_face.push_back(near_face);
  return static_cast<int>(mesh.positions.size()) - 1;
}

}  // namespace

bool is_sound(const SideSplit& split, bool on_boundary) {
  constexpr int kLeastInside = 3, kLeastOnBoundary = 2;
  const std::array<int, 2> here = quads_at_new_vertices(split.fill);
  if (on_boundary) return std::min(here[0], here[1]) >= kLeastOnBoundary;
  const std::array<int, 2> there = quads_at_new_vertices(split.fill_across);
  return std::min(here[0] + there[1], here[1] + there[0]) >= kLeastInside;
}

std::vector<SideSplit> sound_splits(int quad, int side, bool on_boundary) {
  constexpr std::array<HexagonFill, 5> kFills{HexagonFill::kFirstEdge, HexagonFill::kSecondEdge, HexagonFill::kStarAtFirst,
                                              HexagonFill::kStarAtSecond, HexagonFill::kInset};
  std::vector<SideSplit> splits;
  SideSplit split{quad, side};
  for (const HexagonFill fill : kFills)
    for (const HexagonFill fill_across : kFills) {
      split.fill = fill;
      split.fill_across = fill_across;
      if (is_sound(split, on_boundary) && (!on_boundary || fill_across == kFills.front())) splits.push_back(split);
    }
  return splits;
}

Vector3 point_on_side(const QuadMesh& mesh, const Workpiece& piece, const QuadMesh::FeatureEdge* edge, int a, int b,
                      double part) {
  const Vector3 &from = mesh.positions[a], &to = mesh.positions[b];
  if (edge == nullptr) return from + part * (to - from);
  const CurveGeometry& curve = piece.curves[edge->curve];
  const auto arc_of = [&](int v, double end) { return mesh.kind[v] == VertexKind::kCurve ? piece.arc[v] : end; };
  const double begin = arc_of(edge->a, 0);
  double length = arc_of(edge->b, curve.length()) - begin;
  if (curve.closed() && length <= 0) length += curve.length();
  return curve.at(begin + (edge->a == a ? part : 1 - part) * length);
}

std::array<Vector3, 4> path_of(const QuadMesh& mesh, const Workpiece& piece, const QuadMesh::FeatureEdge* edge, const SideSplit& split) {
  const int a = mesh.quads[split.quad][split.side], b = mesh.quads[split.quad][(split.side + 1) & 3];
  const auto at = [&](double part) { return point_on_side(mesh, piece, edge, a, b, part); };
  return {mesh.positions[a], at(split.first), at(split.second), mesh.positions[b]};
}

bool may_split(const QuadMesh::FeatureEdge* edge, const FeatureGraph& features) {
  if (edge == nullptr) return true;
  return edge->curve >= 0 && edge->curve < static_cast<int>(features.curves.size()) && features.curves[edge->curve].asked_count == 0;
}

SideSplitter::SideSplitter(const QuadMesh& mesh, const SurfaceIndex& surface, std::vector<int> region)
    : mesh_(mesh), surface_(surface), region_(std::move(region)), quads_at_(mesh.positions.size()) {
  for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
    for (const int v : mesh.quads[q]) quads_at_[v].push_back(q);
}

int SideSplitter::across(int quad, int side) const {
  const int a = mesh_.quads[quad][side], b = mesh_.quads[quad][(side + 1) & 3];
  for (const int other : quads_at_[a])
    for (int i = 0; i < 4; ++i)
      if (mesh_.quads[other][i] == b && mesh_.quads[other][(i + 1) & 3] == a) return other;
  return -1;
}

const QuadMesh::FeatureEdge* SideSplitter::feature_edge(int a, int b) const {
  for (const QuadMesh::FeatureEdge& e : mesh_.feature_edges)
    if ((e.a == a && e.b == b) || (e.a == b && e.b == a)) return &e;
  return nullptr;
}

QuadMesh SideSplitter::split(const SideSplit& split, const std::array<Vector3, 4>& path, std::vector<int>* changed) const {
  const std::array<int, 4>& v = mesh_.quads[split.quad];
  const int a = v[split.side], b = v[(split.side + 1) & 3], c = v[(split.side + 2) & 3], d = v[(split.side + 3) & 3];
  const QuadMesh::FeatureEdge* edge = feature_edge(a, b);
  QuadMesh out = mesh_;
  const auto add = [&](const Vector3& p) {
    return edge ? add_vertex(out, p, VertexKind::kCurve, edge->curve, -1) : add_inside(out, split.quad, p);
  };
  const int m1 = add(path[1]), m2 = add(path[2]);
  if (edge) {
    const bool is_forward = edge->a == a;
    const int near = is_forward ? m1 : m2, far = is_forward ? m2 : m1;
    out.feature_edges[edge - mesh_.feature_edges.data()].b = near;
    out.feature_edges.push_back({near, far, edge->curve});
    out.feature_edges.push_back({far, edge->b, edge->curve});
  }
  const int other = across(split.quad, split.side);
  fill(out, split.quad, {a, m1, m2, b, c, d}, split.fill, changed);
  if (other < 0) return out;
  const std::array<int, 4>& w = mesh_.quads[other];
  const int k = static_cast<int>(std::find(w.begin(), w.end(), b) - w.begin());
  fill(out, other, {b, m2, m1, a, w[(k + 2) & 3], w[(k + 3) & 3]}, split.fill_across, changed);
  return out;
}

void SideSplitter::fill(QuadMesh& out, int quad, const Hexagon& h, HexagonFill how, std::vector<int>* changed) const {
  const auto middle = [&](int v, int w) -> Vector3 { return 0.5 * (out.positions[v] + out.positions[w]); };
  const auto centre = [&] { return Vector3((middle(h.a, h.b) + middle(h.m1, h.c) + middle(h.m2, h.d)) / 3); };
  std::vector<std::array<int, 4>> quads;
  switch (how) {
    case HexagonFill::kFirstEdge: quads = {{h.m1, h.m2, h.b, h.c}, {h.a, h.m1, h.c, h.d}}; break;
    case HexagonFill::kSecondEdge: quads = {{h.a, h.m1, h.m2, h.d}, {h.m2, h.b, h.c, h.d}}; break;
    case HexagonFill::kStarAtFirst: {
      const int o = add_inside(out, quad, centre());
      quads = {{h.a, h.m1, h.m2, o}, {h.m2, h.b, h.c, o}, {h.c, h.d, h.a, o}};
      break;
    }
    case HexagonFill::kStarAtSecond: {
      const int o = add_inside(out, quad, centre());
      quads = {{h.m1, h.m2, h.b, o}, {h.b, h.c, h.d, o}, {h.d, h.a, h.m1, o}};
      break;
    }
    case HexagonFill::kInset: {
      const int p = add_inside(out, quad, middle(h.m1, h.d)), r = add_inside(out, quad, middle(h.m2, h.c));
      quads = {{h.a, h.m1, p, h.d}, {h.m1, h.m2, r, p}, {h.m2, h.b, h.c, r}, {p, r, h.c, h.d}};
      break;
    }
  }
  out.quads[quad] = quads.front();
  changed->push_back(quad);
  for (std::size_t i = 1; i < quads.size(); ++i) {
    changed->push_back(static_cast<int>(out.quads.size()));
    out.quads.push_back(quads[i]);
  }
}

/// A free vertex on the surface.
int SideSplitter::add_inside(QuadMesh& out, int quad, const Vector3& position) const {
  SurfaceIndex::Filter filter;
  filter.region = region_[quad];
  const SurfacePoint point = surface_.nearest(position, filter);
  return add_vertex(out, point.face < 0 ? position : point.position, VertexKind::kFree, region_[quad], point.face);
}

}  // namespace hybrid_quad
