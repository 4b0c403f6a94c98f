#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "hybrid_quad/mesh/complex_editor.h"
#include "hybrid_quad/singular_patches/discrete_gradient.h"
#include "hybrid_quad/singular_patches/morse_smale_gluing.h"
#include "hybrid_quad/singular_patches/node_chords.h"
#include "hybrid_quad/singular_patches/patch_border.h"
#include "hybrid_quad/singular_patches/patch_quads.h"

namespace hybrid_quad {

namespace {

/// Makes the values finite, and monotone along arcs where they are not.
void clean_values(PatchSurface& patch, const PatchBorder& border) {
  for (double& value : patch.morse)
    if (!std::isfinite(value)) value = 0;
  for (const auto& loop : border)
    for (const PatchArc& arc : loop) {
      const int count = static_cast<int>(arc.halfedges.size());
      const double begin = patch.morse[arc.from], end = patch.morse[arc.to], sign = arc.rising ? 1 : -1;
      const auto value_at = [&](int i) {
        return i < count ? patch.morse[patch.mesh.from(arc.halfedges[i])] : end;
      };
      bool monotone = true;
      for (int i = 0; i < count; ++i) monotone = monotone && sign * (value_at(i + 1) - value_at(i)) > 0;
      for (int i = 1; i < count && !monotone; ++i)
        patch.morse[patch.mesh.from(arc.halfedges[i])] = begin + (end - begin) * i / count;
    }
}

/// The order of the vertices: by value, ties by number; border minima before and border maxima after all
/// others, which makes them extrema of the patch (paper, App. A).
std::vector<int> rank_vertices(const PatchSurface& patch, const PatchBorder& border) {
  std::vector<signed char> level(patch.mesh.vertex_count(), 0);
  for (const auto& loop : border)
    for (const PatchArc& arc : loop) level[arc.from] = arc.rising ? -1 : 1;
  std::vector<int> order(patch.mesh.vertex_count());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::make_tuple(level[a], patch.morse[a], a) < std::make_tuple(level[b], patch.morse[b], b);
  });
  std::vector<int> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<int>(i);
  return rank;
}

/// Along arcs the gradient follows the border, so that each arc is one side of one quad whatever the values
/// inside do.
std::vector<int> descents_along(const PatchSurface& patch, const PatchBorder& border) {
  std::vector<int> forced(patch.mesh.vertex_count(), -1);
  for (const auto& loop : border)
    for (const PatchArc& arc : loop)
      for (const int h : arc.halfedges) {
        const int upper = arc.rising ? patch.mesh.to(h) : patch.mesh.from(h);
        if (upper != arc.from && upper != arc.to) forced[upper] = h;
      }
  return forced;
}

/// Cancels saddles with extrema on the glued quads.
class Simplifier {
 public:
  Simplifier(MorseSmaleComplex& complex, const std::vector<double>& morse)
      : saddle_(complex.saddle), editor_(complex.quads) {
    for (const int v : complex.extremum) value_.push_back(morse[v]);
  }

  void run(double persistence, const RunContext& context) {
    do {
      context.checkpoint();
      while (merge_low_valences()) {
      }
    } while (cancel_below(persistence));
    editor_.compact();
  }

 private:
  const QuadComplex& quads() const { return editor_.complex(); }
  static bool at_minimum(int d) { return d % 2 == 0; }

  /// Extrema of one or two quads inside the patch: no mesh may keep them, whatever their persistence.
  bool merge_low_valences() {
    bool changed = false;
    for (int d = 0; d < static_cast<int>(quads().opposite.size()); ++d) {
      if (!editor_.alive(d / 4)) continue;
      const int v = quads().from(d);
      if (editor_.on_border(v) || editor_.corner_count(v) > 2 || !editor_.can_collapse(d ^ 2)) continue;
      collapse(d ^ 2);
      changed = true;
    }
    return changed;
  }

  /// Persistence of the pair that vanishes when corners d and d + 2 merge.
  double persistence_of(int d) const {
    const double a = value_[quads().from(d)], b = value_[quads().from(d ^ 2)], s = saddle_[d / 4];
    return at_minimum(d) ? s - std::max(a, b) : std::min(a, b) - s;
  }

  bool may_cancel(int d) const {
    if (!editor_.can_collapse(d)) return false;
    const int a = quads().from(d), b = quads().from(d ^ 2);
    const int p = quads().from(d ^ 1), r = quads().from(d ^ 3);
    const auto enough = [](bool border, int corners) { return corners >= (border ? 1 : 3); };
    const int lost = p == r ? 2 : 1;
    return enough(editor_.on_border(a) || editor_.on_border(b),
                  editor_.corner_count(a) + editor_.corner_count(b) - 2) &&
           enough(editor_.on_border(p), editor_.corner_count(p) - lost) &&
           enough(editor_.on_border(r), editor_.corner_count(r) - lost);
  }

  bool cancel_below(double persistence) {
    std::vector<std::pair<double, int>> candidates;
    for (int q = 0; q < quads().quad_count(); ++q)
      for (const int d : {4 * q, 4 * q + 1})
        if (editor_.alive(q) && persistence_of(d) < persistence && may_cancel(d))
          candidates.emplace_back(persistence_of(d), d);
    std::sort(candidates.begin(), candidates.end());
    bool changed = false;
    for (const auto& [expected, d] : candidates) {
      if (!editor_.alive(d / 4) || persistence_of(d) >= persistence || !may_cancel(d)) continue;
      // The more extreme one stays where it is.
      const double a = value_[quads().from(d)], b = value_[quads().from(d ^ 2)];
      const bool first = at_minimum(d) ? a <= b : a >= b;
      collapse(first ? d : d ^ 2);
      changed = true;
    }
    return changed;
  }

  /// from(d) stays unless the other one is a border node; the class keeps the more extreme value of the two.
  void collapse(int d) {
    const double a = value_[quads().from(d)], b = value_[quads().from(d ^ 2)];
    const double extreme = at_minimum(d) ? std::min(a, b) : std::max(a, b);
    value_[editor_.collapse(d)] = extreme;
  }

  const std::vector<double>& saddle_;
  std::vector<double> value_;
  ComplexEditor editor_;
};

PatchQuads export_quads(const QuadComplex& complex) {
  PatchQuads result;
  result.positions = complex.positions;
  result.opposite = complex.opposite;
  result.arc = complex.curve;
  for (std::size_t v = 0; v < complex.kind.size(); ++v)
    result.node.push_back(complex.kind[v] == VertexKind::kCorner ? complex.anchor[v] : -1);
  for (int d = 0; d < static_cast<int>(complex.vertex.size()); d += 4)
    result.quads.push_back(
        {complex.vertex[d], complex.vertex[d + 1], complex.vertex[d + 2], complex.vertex[d + 3]});
  return result;
}

}  // namespace

PatchQuads morse_smale_quads(const PatchSurface& input, double persistence, const RunContext& context) {
  PatchSurface patch = split_node_chords(input);
  const PatchBorder border = border_of(patch);
  clean_values(patch, border);
  const std::vector<int> rank = rank_vertices(patch, border);
  const DiscreteGradient gradient = discrete_gradient(patch.mesh, rank, descents_along(patch, border));
  context.checkpoint();
  MorseSmaleComplex complex = morse_smale_complex(patch, border, rank, gradient, context);
  Simplifier(complex, patch.morse).run(persistence, context);
  return export_quads(complex.quads);
}

}  // namespace hybrid_quad
