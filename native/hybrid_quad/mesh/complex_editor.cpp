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
    corners_.push_back(3);
    border_.push_back(0);
  }
  const int ring = static_cast<int>(complex_.opposite.size());  // its first dart
  const auto ring_dart = [&](int side, int k) { return ring + 4 * (side & 3) + k; };
  for (int i = 0; i < 4; ++i) {
    const int outside = complex_.opposite[4 * q + i];
    const bool own = outside >= 0 && outside / 4 == q;
    for (const int o : {own ? ring_dart(outside & 3, 0) : outside, ring_dart(i + 1, 3), 4 * q + i, ring_dart(i + 3, 1)})
      complex_.opposite.push_back(o);
    for (const int v : {outer[i], outer[(i + 1) & 3], inner[(i + 1) & 3], inner[i]}) complex_.vertex.push_back(v);
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
  corners_.resize(vertices);
  border_.resize(vertices);
  alive_.assign(quads, 1);
  return new_vertex;
}

}  // namespace hybrid_quad
