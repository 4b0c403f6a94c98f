#include "hybrid_quad/mesh/polychords.h"

namespace hybrid_quad {

Polychords trace_polychords(const QuadComplex& complex) {
  const int darts = static_cast<int>(complex.opposite.size());
  Polychords result;
  result.of_dart.assign(darts, -1);
  for (int seed = 0; seed < darts; ++seed) {
    if (result.of_dart[seed] >= 0) continue;
    const int id = static_cast<int>(result.length.size());
    result.length.push_back(0);
    // Inwards from the seed's side, then, unless the strip has closed, outwards.
    for (int start : {seed, complex.opposite[seed]})
      for (int d = start; d >= 0 && result.of_dart[d] < 0; d = complex.opposite[d ^ 2]) {
        result.of_dart[d] = result.of_dart[d ^ 2] = id;
        ++result.length[id];
      }
  }
  return result;
}

std::vector<int> quad_regions(const QuadComplex& complex) {
  std::vector<int> region(complex.quad_count(), -1), front;
  for (int q = 0; q < complex.quad_count(); ++q)
    for (int d = 4 * q; d < 4 * q + 4 && region[q] < 0; ++d)
      if (complex.kind[complex.from(d)] == VertexKind::kFree) region[q] = complex.anchor[complex.from(d)];
  for (int q = 0; q < complex.quad_count(); ++q)
    if (region[q] >= 0) front.push_back(q);
  for (std::size_t i = 0; i < front.size(); ++i)
    for (int d = 4 * front[i]; d < 4 * front[i] + 4; ++d) {
      const int o = complex.opposite[d];
      if (o < 0 || complex.curve[d] >= 0 || region[o / 4] >= 0) continue;
      region[o / 4] = region[front[i]];
      front.push_back(o / 4);
    }
  return region;
}

namespace {

/// Every quad as a grid of 1 or 2 by 1 or 2 quads.
class Splitter {
 public:
  Splitter(const QuadComplex& old, const Polychords& polychords, const std::vector<char>& chosen)
      : old_(old), region_(quad_regions(old)), cut_(old.opposite.size()), middle_(old.opposite.size(), -1) {
    for (std::size_t d = 0; d < cut_.size(); ++d) cut_[d] = chosen[polychords.of_dart[d]];
    int quads = 0;
    for (int q = 0; q < old.quad_count(); ++q) {
      first_.push_back(quads);
      quads += columns(q) * rows(q);
    }
    result_.opposite.assign(4 * quads, -1);
    result_.vertex.assign(4 * quads, -1);
    result_.curve.assign(4 * quads, -1);
    result_.positions = old.positions;
    result_.kind = old.kind;
    result_.anchor = old.anchor;
    result_.near_face = old.near_face;
  }

  QuadComplex run() {
    for (int d = 0; d < static_cast<int>(cut_.size()); ++d) {
      if (!cut_[d] || middle_[d] >= 0) continue;
      const Vector3 p = 0.5 * (old_.positions[old_.from(d)] + old_.positions[old_.to(d)]);
      const int near = old_.near_face[old_.from(d)];
      middle_[d] =
          old_.curve[d] >= 0 ? add(p, VertexKind::kCurve, old_.curve[d], near) : add(p, VertexKind::kFree, region_[d / 4], near);
      if (old_.opposite[d] >= 0) middle_[old_.opposite[d]] = middle_[d];
    }
    for (int q = 0; q < old_.quad_count(); ++q) fill(q);
    for (int d = 0; d < static_cast<int>(cut_.size()); ++d)
      for (int k = 0; k < parts(d); ++k) {
        result_.curve[part(d, k)] = old_.curve[d];
        const int o = old_.opposite[d];
        if (o >= 0) result_.opposite[part(d, k)] = part(o, parts(d) - 1 - k);
      }
    return std::move(result_);
  }

 private:
  int parts(int d) const { return cut_[d] ? 2 : 1; }
  int columns(int q) const { return parts(4 * q); }
  int rows(int q) const { return parts(4 * q + 1); }
  int sub(int q, int i, int j) const { return first_[q] + j * columns(q) + i; }

  /// The k-th part of a side, in its direction.
  int part(int d, int k) const {
    const int q = d / 4, n = columns(q), m = rows(q);
    switch (d & 3) {
      case 0:
        return 4 * sub(q, k, 0);
      case 1:
        return 4 * sub(q, n - 1, k) + 1;
      case 2:
        return 4 * sub(q, n - 1 - k, m - 1) + 2;
      default:
        return 4 * sub(q, 0, m - 1 - k) + 3;
    }
  }

  int add(const Vector3& p, VertexKind kind, int anchor, int near_face) {
    result_.positions.push_back(p);
    result_.kind.push_back(kind);
    result_.anchor.push_back(anchor);
    result_.near_face.push_back(near_face);
    return static_cast<int>(result_.positions.size()) - 1;
  }

  void fill(int q) {
    const int n = columns(q), m = rows(q);
    const int* corner = &old_.vertex[4 * q];
    int center = -1;
    if (n == 2 && m == 2) {
      const auto& p = old_.positions;
      center = add(0.25 * (p[corner[0]] + p[corner[1]] + p[corner[2]] + p[corner[3]]), VertexKind::kFree, region_[q],
                   old_.near_face[corner[0]]);
    }
    const auto at = [&](int i, int j) {
      if (i % n == 0 && j % m == 0) return corner[j == 0 ? (i == 0 ? 0 : 1) : (i == 0 ? 3 : 2)];
      if (j % m == 0) return middle_[4 * q + (j == 0 ? 0 : 2)];
      if (i % n == 0) return middle_[4 * q + (i == 0 ? 3 : 1)];
      return center;
    };
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < n; ++i) {
        const int d = 4 * sub(q, i, j);
        const int corners[4] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        for (int k = 0; k < 4; ++k) result_.vertex[d + k] = corners[k];
        if (i + 1 < n) glue(d + 1, 4 * sub(q, i + 1, j) + 3);
        if (j + 1 < m) glue(d + 2, 4 * sub(q, i, j + 1));
      }
  }

  void glue(int d, int e) {
    result_.opposite[d] = e;
    result_.opposite[e] = d;
  }

  const QuadComplex& old_;
  std::vector<int> region_;
  std::vector<char> cut_;
  std::vector<int> middle_, first_;
  QuadComplex result_;
};

}  // namespace

QuadComplex split_polychords(const QuadComplex& complex, const Polychords& polychords,
                             const std::vector<char>& chosen) {
  return Splitter(complex, polychords, chosen).run();
}

}  // namespace hybrid_quad
