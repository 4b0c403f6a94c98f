#include <algorithm>
#include <limits>
#include <numeric>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/complex_editor.h"
#include "hybrid_quad/mesh/polychords.h"
#include "hybrid_quad/mesh/quad_complex.h"

namespace hybrid_quad {

namespace {

constexpr int kFewQuads = 8;        // so few are never made fewer: a closed surface would vanish
constexpr int kLongestCascade = 3;
constexpr int kLocalRounds = 10;    // then polychords only
constexpr int kSparingRounds = 25;  // then everything near a defect
constexpr int kMostRounds = 40;
constexpr int kStripPerDefect =
    8;  // a polychord is worth splitting up to this length for each double edge it resolves

/// Inner vertices of one or two quads, by collapses first, then, where features forbid them or one collapse calls for
/// the next, by rings: along a tube with few quads around, collapses would go on to its other end.
void fix_low_valences(QuadComplex& complex, ComplexRepairReport& report) {
  ComplexEditor editor(complex);
  std::vector<int> after(complex.positions.size(), 0);  // how many collapses in a row led to the vertex
  const auto is_low = [&](int d) {
    const int v = complex.from(d);
    return editor.alive(d / 4) && !editor.on_border(v) && editor.corner_count(v) <= 2;
  };
  for (bool changed = true; changed && editor.alive_count() > kFewQuads;) {
    changed = false;
    for (int d = 0; d < static_cast<int>(complex.opposite.size()) && editor.alive_count() > kFewQuads; ++d) {
      if (!is_low(d) || after[complex.from(d)] >= kLongestCascade || !editor.can_collapse(d ^ 2)) continue;
      const int next = after[complex.from(d)] + 1;
      for (int corner = d & ~3; corner <= (d | 3); ++corner)
        after[complex.from(corner)] = std::max(after[complex.from(corner)], next);
      ++(editor.corner_count(complex.from(d)) == 1 ? report.cancelled_singlets : report.merged_doublets);
      editor.collapse(d ^ 2);
      changed = true;
    }
  }
  editor.compact();
  std::vector<int> region = quad_regions(complex);
  for (int d = 0; d < static_cast<int>(complex.opposite.size()); ++d) {
    if (!is_low(d)) continue;
    editor.inset(d / 4, region[d / 4]);
    region.resize(complex.quad_count(), region[d / 4]);
    ++report.inset_quads;
  }
}

/// What an indexed mesh cannot hold, once no inner valence is below three.
struct Defects {
  std::vector<std::vector<int>>
      double_edges;             ///< each: one dart for every edge between the same two vertices
  std::vector<int> loop_edges;  ///< darts from a vertex to itself
  std::vector<std::vector<int>> short_borders;  ///< border loops of fewer than four darts
  bool empty() const { return double_edges.empty() && loop_edges.empty() && short_borders.empty(); }
};

void find_short_borders(const QuadComplex& c, Defects& found) {
  std::vector<char> seen(c.opposite.size(), 0);
  for (int seed = 0; seed < static_cast<int>(c.opposite.size()); ++seed) {
    if (c.opposite[seed] >= 0 || seen[seed]) continue;
    std::vector<int> loop;
    for (int d = seed; !seen[d];) {
      seen[d] = 1;
      loop.push_back(d);
      d = QuadComplex::next(d);
      while (c.opposite[d] >= 0) d = QuadComplex::next(c.opposite[d]);
    }
    if (loop.size() < 4) found.short_borders.push_back(loop);
  }
}

Defects find_defects(const QuadComplex& c) {
  Defects found;
  std::vector<std::array<int, 3>> edges;  // lower vertex, higher vertex, dart
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d) {
    if (c.opposite[d] >= 0 && c.opposite[d] < d) continue;
    if (c.from(d) == c.to(d))
      found.loop_edges.push_back(d);
    else
      edges.push_back({std::min(c.from(d), c.to(d)), std::max(c.from(d), c.to(d)), d});
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j][0] == edges[i][0] && edges[j][1] == edges[i][1]) ++j;
    if (j - i > 1) {
      found.double_edges.emplace_back();
      for (; i < j; ++i) found.double_edges.back().push_back(edges[i][2]);
    }
    i = j;
  }
  find_short_borders(c, found);
  return found;
}

/// Which polychords to split for a set of defects, as few quads as a greedy choice finds.
class PolychordChoice {
 public:
  PolychordChoice(const QuadComplex& complex, const Defects& defects, const std::vector<char>& counted)
      : polychords_(trace_polychords(complex)),
        chosen_(polychords_.length.size(), 0),
        use_(polychords_.length.size(), 0) {
    // As long as any strip can be: chosen where nothing else will do.
    if (!counted.empty())
      for (std::size_t d = 0; d < complex.curve.size(); ++d)
        if (complex.curve[d] >= 0 && counted[complex.curve[d]])
          polychords_.length[polychords_.of_dart[d]] += 2 * complex.quad_count();
    std::vector<int> last(use_.size(), -1);
    for (int g = 0; g < static_cast<int>(defects.double_edges.size()); ++g)
      for (const int d : defects.double_edges[g]) {
        const int p = polychords_.of_dart[d];
        use_[p] += last[p] != g;
        last[p] = g;
      }
  }

  void choose(int p) { chosen_[p] = 1; }
  void choose_at(int d) { choose(polychords_.of_dart[d]); }

  /// All but one of these edges, cheapest strips first. \param any_length  whatever the length; otherwise
  /// only what is worth it
  void choose_for_double_edge(const std::vector<int>& darts, bool any_length) {
    std::vector<int> order = darts;
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::make_pair(price(a), a) < std::make_pair(price(b), b); });
    int left = 0;
    for (const int d : order) left += !chosen_[polychords_.of_dart[d]];
    for (std::size_t i = 0; i < order.size() && left > 1; ++i) {
      const int p = polychords_.of_dart[order[i]];
      if (chosen_[p] || (!any_length && price(order[i]) > kStripPerDefect)) continue;
      choose(p);
      left = 0;
      for (const int d : order) left += !chosen_[polychords_.of_dart[d]];
    }
  }

  /// One of these, unless one is chosen already.
  void choose_shortest(const std::vector<int>& darts) {
    int best = darts[0];
    for (const int d : darts) {
      if (chosen_[polychords_.of_dart[d]]) return;
      if (length(d) < length(best)) best = d;
    }
    choose_at(best);
  }

  int split(QuadComplex& complex) const {
    const int count = static_cast<int>(std::count(chosen_.begin(), chosen_.end(), 1));
    if (count > 0) complex = split_polychords(complex, polychords_, chosen_);
    return count;
  }

 private:
  int length(int d) const { return polychords_.length[polychords_.of_dart[d]]; }
  double price(int d) const {
    return static_cast<double>(length(d)) / std::max(1, use_[polychords_.of_dart[d]]);
  }

  Polychords polychords_;
  std::vector<char> chosen_;
  std::vector<int> use_;  ///< double edges each polychord would resolve
};

/// Takes double edges away one by one without touching more than two quads each. \return how many
int restar_double_edges(QuadComplex& complex, const Defects& defects) {
  std::vector<int> region = quad_regions(complex);
  ComplexEditor editor(complex);
  std::vector<char> touched(complex.quad_count(), 0);
  int count = 0;
  for (const auto& group : defects.double_edges) {
    int best = -1, cost = std::numeric_limits<int>::max();
    for (const int edge : group)
      for (const int d : {edge, complex.opposite[edge]})
        if (d >= 0 && !touched[d / 4] && complex.opposite[d] >= 0 && !touched[complex.opposite[d] / 4] &&
            editor.can_restar(d) && editor.restar_valence_cost(d) < cost) {
          best = d;
          cost = editor.restar_valence_cost(d);
        }
    if (best < 0) continue;
    touched[best / 4] = touched[complex.opposite[best] / 4] = 1;
    editor.restar(best, region[best / 4]);
    region.push_back(region[best / 4]);
    touched.push_back(1);
    ++count;
  }
  return count;
}

}  // namespace

ComplexRepairReport repair_complex(QuadComplex& complex, const std::vector<char>& counted) {
  ComplexRepairReport report;
  fix_low_valences(complex, report);
  for (int round = 0; round < kMostRounds; ++round) {
    const Defects defects = find_defects(complex);
    if (defects.empty()) return report;
    PolychordChoice choice(complex, defects, counted);
    const bool local = round < kLocalRounds;
    for (const int d : defects.loop_edges) choice.choose_at(d);
    for (const auto& loop : defects.short_borders) choice.choose_shortest(loop);
    for (const auto& group : defects.double_edges) choice.choose_for_double_edge(group, !local);
    if (round >= kSparingRounds)
      for (const auto& group : defects.double_edges)
        for (const int edge : group)
          for (const int d : {edge, complex.opposite[edge]})
            for (int i = 0; d >= 0 && i < 4; ++i) choice.choose_at((d & ~3) | i);
    int split = choice.split(complex);
    if (split == 0) {
      const int restarred = restar_double_edges(complex, defects);
      report.restarred_edges += restarred;
      if (restarred == 0) {
        for (const auto& group : defects.double_edges) choice.choose_for_double_edge(group, true);
        split = choice.split(complex);
      }
    }
    report.split_polychords += split;
  }
  if (!find_defects(complex).empty())
    throw InternalError("repair", "a complex could not be made an indexed mesh");
  return report;
}

}  // namespace hybrid_quad
