#include "hybrid_quad/mesh/polychord_collapse.h"

#include <algorithm>

namespace hybrid_quad {

namespace {

constexpr int kLeastEdgesOfLoop = 4;  ///< of a curve that ends nowhere

/// Quads with feature edges on opposite sides.
int lone_quads(const QuadComplex& c) {
  int count = 0;
  for (int d = 0; d < static_cast<int>(c.curve.size()); d += 4)
    count += (c.curve[d] >= 0 && c.curve[d + 2] >= 0) || (c.curve[d + 1] >= 0 && c.curve[d + 3] >= 0);
  return count;
}

class PolychordCollapse {
 public:
  PolychordCollapse(const QuadComplex& complex, const Polychords& polychords, const std::vector<char>& chosen)
      : complex_(complex), of_dart_(polychords.of_dart), chosen_(chosen), partner_(complex.positions.size(), -1) {}

  bool run(QuadComplex& result) {
    if (!pair_vertices() || !curves_keep_edges()) return false;
    result = complex_;
    merge_vertices(result);
    for (int q = 0; q < complex_.quad_count(); ++q)
      if (is_removed(q) && !glue_sides_of(q, result)) return false;
    compact(result);
    return is_sound(result);
  }

 private:
  int dart_count() const { return static_cast<int>(complex_.opposite.size()); }
  bool is_crossed(int d) const { return chosen_[of_dart_[d]] != 0; }
  bool is_removed(int q) const { return is_crossed(4 * q) || is_crossed(4 * q + 1); }

  /// Whether the ends of crossed sides are pairs, and each pair may become one.
  bool pair_vertices() {
    for (int d = 0; d < dart_count(); ++d) {
      if (!is_crossed(d)) continue;
      if (is_crossed(QuadComplex::next(d))) return false;
      const int a = complex_.from(d), b = complex_.to(d);
      if (a == b || !may_meet(a, b, complex_.curve[d])) return false;
      for (const auto& [v, w] : {std::array<int, 2>{a, b}, std::array<int, 2>{b, a}}) {
        if (partner_[v] >= 0 && partner_[v] != w) return false;
        partner_[v] = w;
      }
    }
    return true;
  }

  bool may_meet(int a, int b, int curve) const {
    const VertexKind low = std::min(complex_.kind[a], complex_.kind[b]), high = std::max(complex_.kind[a], complex_.kind[b]);
    return low == VertexKind::kFree || (curve >= 0 && !(low == VertexKind::kCorner && high == VertexKind::kCorner));
  }

  bool curves_keep_edges() const {
    const int curves = complex_.curve.empty() ? 0 : 1 + *std::max_element(complex_.curve.begin(), complex_.curve.end());
    std::vector<int> sides(curves, 0), lost(curves, 0);  // counted on both sides of an edge alike
    std::vector<char> ends(curves, 0);
    for (int d = 0; d < dart_count(); ++d) {
      const int c = complex_.curve[d];
      if (c < 0) continue;
      const int weight = complex_.opposite[d] < 0 ? 2 : 1;
      sides[c] += weight;
      if (is_crossed(d)) lost[c] += weight;
      if (complex_.kind[complex_.from(d)] == VertexKind::kCorner) ends[c] = 1;
    }
    for (int c = 0; c < curves; ++c)
      if (lost[c] > 0 && sides[c] - lost[c] < 2 * (ends[c] ? 1 : kLeastEdgesOfLoop)) return false;
    return true;
  }

  /// The ends of a crossed side become the one that is more bound; of equals, the first, in the middle.
  void merge_vertices(QuadComplex& result) const {
    std::vector<int> becomes(complex_.positions.size());
    for (int a = 0; a < static_cast<int>(becomes.size()); ++a) {
      const int b = partner_[a];
      const bool stays = b < 0 || complex_.kind[a] > complex_.kind[b] || (complex_.kind[a] == complex_.kind[b] && a < b);
      becomes[a] = stays ? a : b;
      if (b >= 0 && complex_.kind[a] == complex_.kind[b])
        result.positions[a] = 0.5 * (complex_.positions[a] + complex_.positions[b]);
    }
    for (int& v : result.vertex) v = becomes[v];
  }

  /// Glues what lies beyond the two sides along the strip. \return whether that can be
  static bool glue_pair(QuadComplex& result, int left, int right, int curve) {
    if (left < 0 && right < 0) return false;
    for (const auto& [x, y] : {std::array<int, 2>{left, right}, std::array<int, 2>{right, left}})
      if (x >= 0) {
        result.opposite[x] = y;
        result.curve[x] = curve;
      }
    return true;
  }

  bool glue_sides_of(int q, QuadComplex& result) const {
    const int along = 4 * q + (is_crossed(4 * q) ? 1 : 0);
    const int a = result.opposite[along], b = result.opposite[along ^ 2];
    if ((a >= 0 && a / 4 == q) || (b >= 0 && b / 4 == q)) return false;
    const int first = complex_.curve[along], second = complex_.curve[along ^ 2];
    if (first >= 0 && second >= 0) return false;
    return glue_pair(result, a, b, std::max(first, second));
  }

  void compact(QuadComplex& result) const {
    std::vector<int> new_quad(complex_.quad_count(), -1), new_vertex(result.positions.size(), -1);
    QuadComplex out;
    int quads = 0;
    for (int q = 0; q < complex_.quad_count(); ++q)
      if (!is_removed(q)) new_quad[q] = quads++;
    for (int d = 0; d < dart_count(); ++d) {
      if (new_quad[d / 4] < 0) continue;
      int& v = new_vertex[result.vertex[d]];
      if (v < 0) v = 0;
    }
    int vertices = 0;
    for (std::size_t v = 0; v < new_vertex.size(); ++v) {
      if (new_vertex[v] < 0) continue;
      new_vertex[v] = vertices++;
      out.positions.push_back(result.positions[v]);
      out.kind.push_back(result.kind[v]);
      out.anchor.push_back(result.anchor[v]);
      out.near_face.push_back(result.near_face[v]);
    }
    for (int d = 0; d < dart_count(); ++d) {
      if (new_quad[d / 4] < 0) continue;
      const int o = result.opposite[d];
      out.opposite.push_back(o < 0 ? -1 : 4 * new_quad[o / 4] + (o & 3));
      out.vertex.push_back(new_vertex[result.vertex[d]]);
      out.curve.push_back(result.curve[d]);
    }
    result = std::move(out);
  }

  /// What is quick to see comes first: most rows that may not go are tried over and over.
  bool is_sound(const QuadComplex& result) const {
    const int euler = euler_characteristic(complex_);
    if (result.quad_count() == 0 || lone_quads(result) > lone_quads(complex_) || !violations_of(result).empty()) return false;
    if (euler_characteristic(result) != euler) return false;
    const QuadMesh mesh = to_quad_mesh(result);
    return violations_of(mesh).empty() && euler_characteristic(mesh) == euler;
  }

  const QuadComplex& complex_;
  const std::vector<int>& of_dart_;
  const std::vector<char>& chosen_;
  std::vector<int> partner_;
};

}  // namespace

bool collapse_polychords(QuadComplex& complex, const Polychords& polychords, const std::vector<char>& chosen) {
  QuadComplex result;
  if (!PolychordCollapse(complex, polychords, chosen).run(result)) return false;
  complex = std::move(result);
  return true;
}

}  // namespace hybrid_quad
