#include "hybrid_quad/mesh/complex_editor.h"

namespace hybrid_quad {

ComplexEditor::ComplexEditor(QuadComplex& complex)
    : complex_(complex),
      alive_(complex.quad_count(), 1),
      corners_(complex.positions.size(), 0),
      border_(complex.positions.size(), 0),
      alive_count_(complex.quad_count()) {
  for (int d = 0; d < static_cast<int>(complex.opposite.size()); ++d) {
    ++corners_[complex.from(d)];
    if (complex.opposite[d] < 0) border_[complex.from(d)] = border_[complex.to(d)] = 1;
  }
}

int ComplexEditor::folds(int d, std::array<Fold, 2>& out) const {
  const int q = d / 4;
  // Sides d, d + 1 fold onto each other, and so do d + 2, d + 3: within the quad they are partners.
  const auto partner = [&](int e) { return ((e - d) & 1) ? QuadComplex::previous(e) : QuadComplex::next(e); };
  std::array<bool, 4> done{};
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    int e = 4 * q + i;
    if (done[i] || (complex_.opposite[e] >= 0 && complex_.opposite[e] / 4 == q)) continue;
    Fold fold;
    fold.first = complex_.opposite[e];
    fold.curve = complex_.curve[e];
    int features = fold.curve >= 0;
    while (true) {
      done[e & 3] = true;
      e = partner(e);
      done[e & 3] = true;
      if (complex_.curve[e] >= 0) {
        ++features;
        fold.curve = complex_.curve[e];
      }
      fold.last = complex_.opposite[e];
      if (fold.last < 0 || fold.last / 4 != q) break;
      e = fold.last;
    }
    fold.allowed = features <= 1 && (fold.first >= 0 || fold.last >= 0);
    out[count++] = fold;
  }
  return count;
}

bool ComplexEditor::can_collapse(int d) const {
  if (!alive(d / 4)) return false;
  const int a = complex_.from(d), b = complex_.from(d ^ 2);
  if (a == b || (border_[a] && border_[b])) return false;
  if (complex_.kind[a] != VertexKind::kFree && complex_.kind[b] != VertexKind::kFree) return false;
  std::array<Fold, 2> fold;
  const int count = folds(d, fold);
  for (int i = 0; i < count; ++i)
    if (!fold[i].allowed) return false;
  return count > 0;
}

int ComplexEditor::collapse(int d) {
  const int q = d / 4;
  const int other = d ^ 2;
  const bool keep_first = binding(complex_.from(d)) >= binding(complex_.from(other));
  const int kept = complex_.from(keep_first ? d : other), dropped = complex_.from(keep_first ? other : d);
  std::array<Fold, 2> fold;
  const int count = folds(d, fold);

  const int seed = keep_first ? other : d;
  int e = seed;
  do {  // counterclockwise around the vertex that goes
    complex_.vertex[e] = kept;
    e = complex_.opposite[QuadComplex::previous(e)];
  } while (e >= 0 && e != seed);
  if (e < 0)
    for (int o = complex_.opposite[seed]; o >= 0; o = complex_.opposite[e]) {
      e = QuadComplex::next(o);
      complex_.vertex[e] = kept;
    }
  corners_[kept] += corners_[dropped];
  corners_[dropped] = 0;
  border_[kept] = static_cast<char>(border_[kept] || border_[dropped]);
  for (int i = 0; i < 4; ++i) --corners_[complex_.vertex[4 * q + i]];

  for (int i = 0; i < count; ++i) {
    const Fold& f = fold[i];
    for (const auto& [x, y] : {std::array<int, 2>{f.first, f.last}, std::array<int, 2>{f.last, f.first}}) {
      if (x < 0) continue;
      complex_.opposite[x] = y;
      complex_.curve[x] = f.curve;
    }
  }
  alive_[q] = 0;
  --alive_count_;
  return kept;
}

void ComplexEditor::inset(int q, int anchor) {
  std::array<int, 4> outer, inner;  // vertices
  Vector3 center = Vector3::Zero();
  for (int i = 0; i < 4; ++i) {
    outer[i] = complex_.vertex[4 * q + i];
    center += 0.25 * complex_.positions[outer[i]];
  }
  for (int i = 0; i < 4; ++i) {
    inner[i] = static_cast<int>(complex_.positions.size());
    const Vector3 p = 0.5 * (complex_.positions[outer[i]] + center);
    complex_.positions.push_back(p);
    complex_.kind.push_back(VertexKind::kFree);
    complex_.anchor.push_back(anchor);
    complex_.near_face.push_back(complex_.near_face[outer[i]]);
    corners_.push_back(3);
    border_.push_back(0);
  }
  const int ring = static_cast<int>(complex_.opposite.size());  // its first dart
  const auto ring_dart = [&](int side, int k) { return ring + 4 * (side & 3) + k; };
  for (int i = 0; i < 4; ++i) {
    const int outside = complex_.opposite[4 * q + i];
    const bool own = outside >= 0 && outside / 4 == q;
    for (const int o :
         {own ? ring_dart(outside & 3, 0) : outside, ring_dart(i + 1, 3), 4 * q + i, ring_dart(i + 3, 1)})
      complex_.opposite.push_back(o);
    for (const int v : {outer[i], outer[(i + 1) & 3], inner[(i + 1) & 3], inner[i]})
      complex_.vertex.push_back(v);
    for (const int c : {complex_.curve[4 * q + i], -1, -1, -1}) complex_.curve.push_back(c);
    alive_.push_back(1);
    ++corners_[outer[i]];
  }
  for (int i = 0; i < 4; ++i) {
    const int outside = complex_.opposite[ring_dart(i, 0)];
    if (outside >= 0) complex_.opposite[outside] = ring_dart(i, 0);
  }
  for (int i = 0; i < 4; ++i) {
    complex_.opposite[4 * q + i] = ring_dart(i, 2);
    complex_.vertex[4 * q + i] = inner[i];
    complex_.curve[4 * q + i] = -1;
  }
  alive_count_ += 4;
}

namespace {

/// The vertices of restar's hexagon that gain a quad: those after to(d) on the left and before it on the
/// right.
std::array<int, 2> gaining(const QuadComplex& c, int d) {
  return {c.to(QuadComplex::next(d)), c.from(QuadComplex::previous(c.opposite[d]))};
}

}  // namespace

bool ComplexEditor::can_restar(int d) const {
  const int o = complex_.opposite[d];
  if (!alive(d / 4) || o < 0 || o / 4 == d / 4 || complex_.curve[d] >= 0) return false;
  const int joined = complex_.from(d), spared = complex_.to(d);
  if (corners_[spared] < (border_[spared] ? 2 : 4)) return false;
  const auto [c, b] = gaining(complex_, d);
  return b != c && b != joined && c != joined;
}

int ComplexEditor::restar_valence_cost(int d) const {
  const auto change = [&](int v, int by) {
    const int off = corners_[v] - (border_[v] ? 2 : 4);
    return (off + by) * (off + by) - off * off;
  };
  const auto [c, b] = gaining(complex_, d);
  return change(complex_.to(d), -1) + change(c, 1) + change(b, 1) + 1;
}

void ComplexEditor::restar(int d, int anchor) {
  const int o = complex_.opposite[d], l = 4 * (d / 4), r = 4 * (o / 4),
            n = static_cast<int>(complex_.opposite.size());
  const int d1 = QuadComplex::next(d), d2 = d ^ 2, d3 = QuadComplex::previous(d);
  const int o1 = QuadComplex::next(o), o2 = o ^ 2, o3 = QuadComplex::previous(o);
  const int u = complex_.from(d), v = complex_.to(d), c = complex_.to(d1), e = complex_.to(d2);
  const int a = complex_.to(o1), b = complex_.to(o2), w = static_cast<int>(complex_.positions.size());
  const auto& p = complex_.positions;
  const Vector3 middle = (p[u] + p[v] + p[c] + p[e] + p[a] + p[b]) / 6.0;
  complex_.positions.push_back(middle);
  complex_.kind.push_back(VertexKind::kFree);
  complex_.anchor.push_back(anchor);
  complex_.near_face.push_back(complex_.near_face[u]);
  corners_.push_back(3);
  border_.push_back(0);
  --corners_[v];
  ++corners_[b];
  ++corners_[c];

  // The six outer sides and where they go: left quad (w, c, e, u), right quad (w, u, a, b), new quad (w, b,
  // v, c).
  const std::array<int, 6> old_side{d1, d2, d3, o1, o2, o3},
      new_side{n + 2, l + 1, l + 2, r + 1, r + 2, n + 1};
  std::array<int, 6> beyond, curve;
  for (int i = 0; i < 6; ++i) {
    beyond[i] = complex_.opposite[old_side[i]];
    curve[i] = complex_.curve[old_side[i]];
    for (int k = 0; k < 6; ++k)
      if (complex_.opposite[old_side[i]] == old_side[k]) beyond[i] = new_side[k];
  }
  for (std::vector<int>* sides : {&complex_.opposite, &complex_.vertex, &complex_.curve})
    sides->resize(n + 4, -1);
  alive_.push_back(1);
  ++alive_count_;
  const std::array<std::array<int, 4>, 3> quads{{{w, c, e, u}, {w, u, a, b}, {w, b, v, c}}};
  const std::array<int, 3> first{l, r, n};
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 4; ++i) {
      complex_.vertex[first[k] + i] = quads[k][i];
      complex_.curve[first[k] + i] = -1;
    }
  const auto glue = [&](int x, int y) {
    complex_.opposite[x] = y;
    if (y >= 0) complex_.opposite[y] = x;
  };
  glue(l, n + 3);
  glue(l + 3, r);
  glue(r + 3, n);
  for (int i = 0; i < 6; ++i) {
    glue(new_side[i], beyond[i]);
    complex_.curve[new_side[i]] = curve[i];
  }
}

std::vector<int> ComplexEditor::compact() {
  QuadComplex& c = complex_;
  std::vector<int> new_quad(alive_.size(), -1), new_vertex(c.positions.size(), -1);
  int quads = 0, vertices = 0;
  for (std::size_t q = 0; q < alive_.size(); ++q)
    if (alive_[q]) new_quad[q] = quads++;
  for (std::size_t v = 0; v < new_vertex.size(); ++v)
    if (corners_[v] > 0) new_vertex[v] = vertices++;
  for (std::size_t v = 0; v < new_vertex.size(); ++v) {
    const int n = new_vertex[v];
    if (n < 0) continue;
    c.positions[n] = Vector3(c.positions[v]);
    c.kind[n] = c.kind[v];
    c.anchor[n] = c.anchor[v];
    c.near_face[n] = c.near_face[v];
    corners_[n] = corners_[v];
    border_[n] = border_[v];
  }
  for (std::size_t d = 0; d < c.opposite.size(); ++d) {
    if (!alive_[d / 4]) continue;
    const int n = 4 * new_quad[d / 4] + static_cast<int>(d & 3), o = c.opposite[d];
    c.opposite[n] = o < 0 ? -1 : 4 * new_quad[o / 4] + (o & 3);
    c.vertex[n] = new_vertex[c.vertex[d]];
    c.curve[n] = c.curve[d];
  }
  c.opposite.resize(4 * quads);
  c.vertex.resize(4 * quads);
  c.curve.resize(4 * quads);
  c.positions.resize(vertices);
  c.kind.resize(vertices);
  c.anchor.resize(vertices);
  c.near_face.resize(vertices);
  corners_.resize(vertices);
  border_.resize(vertices);
  alive_.assign(quads, 1);
  return new_vertex;
}

}  // namespace hybrid_quad
