#include "hybrid_quad/mesh/quad_count.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hybrid_quad/mesh/polychord_collapse.h"
#include "hybrid_quad/mesh/polychords.h"

namespace hybrid_quad {

namespace {

constexpr double kMostChange = 1 / 3.0;  // of the number

/// A strip of quads and how much wider than long its quads are, in logarithms, on average.
struct Row {
  int id, length;
  double width;
};

/// The rows that may be split or taken out, the narrowest first.
std::vector<Row> rows_of(const QuadComplex& complex, const Polychords& polychords, const std::vector<char>& counted) {
  std::vector<double> sum(polychords.length.size(), 0);
  std::vector<char> is_fixed(polychords.length.size(), 0);
  const auto length = [&](int d) { return (complex.positions[complex.to(d)] - complex.positions[complex.from(d)]).norm(); };
  for (int d = 0; d < static_cast<int>(complex.opposite.size()); ++d) {
    const int id = polychords.of_dart[d], curve = complex.curve[d];
    if (curve >= 0 && !counted.empty() && counted[curve]) is_fixed[id] = 1;
    const double across = length(d), along = length(QuadComplex::next(d)) + length(QuadComplex::previous(d));
    if (across > 0 && along > 0) sum[id] += 0.5 * std::log(2 * across / along);
  }
  std::vector<Row> rows;
  for (std::size_t id = 0; id < sum.size(); ++id)
    if (!is_fixed[id]) rows.push_back({static_cast<int>(id), polychords.length[id], sum[id] / polychords.length[id]});
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.width < b.width; });
  return rows;
}

bool split_widest(QuadComplex& complex, double room, const std::vector<char>& counted) {
  const Polychords polychords = trace_polychords(complex);
  const std::vector<Row> rows = rows_of(complex, polychords, counted);
  const auto widest = std::find_if(rows.rbegin(), rows.rend(), [&](const Row& row) { return row.length <= room; });
  if (widest == rows.rend()) return false;
  std::vector<char> chosen(polychords.length.size(), 0);
  chosen[widest->id] = 1;
  complex = split_polychords(complex, polychords, chosen);
  return true;
}

/// Takes out one row after the other. One that may not go is tried again only when something changed beside it: surfaces with
/// many handles have thousands of rows, and hardly one that may go.
class RowRemoval {
 public:
  explicit RowRemoval(const QuadComplex& complex) : may_not_go_(complex.opposite.size(), 0) {}

  bool collapse_narrowest(QuadComplex& complex, double room, const std::vector<char>& counted) {
    const Polychords polychords = trace_polychords(complex);
    const std::vector<int> vertex = complex.vertex;
    std::vector<char> fails(polychords.length.size(), 0);
    for (std::size_t d = 0; d < may_not_go_.size(); ++d)
      if (may_not_go_[d]) fails[polychords.of_dart[d]] = 1;
    for (const Row& row : rows_of(complex, polychords, counted)) {
      if (row.length > room || fails[row.id]) continue;
      if (collapse_polychord(complex, polychords, row.id)) {
        remember(vertex, polychords, row.id, fails);
        return true;
      }
      fails[row.id] = 1;
    }
    return false;
  }

 private:
  /// What fails far from the row that went still does: whether a row may go depends on the quads around its vertices, and on the
  /// number of edges of curves, which only falls.
  /// \param vertex, polychords  of the complex before
  void remember(const std::vector<int>& vertex, const Polychords& polychords, int gone, std::vector<char>& fails) {
    const int darts = static_cast<int>(vertex.size());
    const std::size_t vertices = vertex.empty() ? 0 : 1 + *std::max_element(vertex.begin(), vertex.end());
    std::vector<char> moved(vertices, 0), is_near(vertices, 0);
    for (int d = 0; d < darts; ++d)
      if (polychords.of_dart[d] == gone) moved[vertex[d]] = moved[vertex[QuadComplex::next(d)]] = 1;
    for (int q = 0; q < darts; q += 4) {
      const auto corners = vertex.begin() + q;
      if (std::any_of(corners, corners + 4, [&](int v) { return moved[v] != 0; }))
        for (int i = 0; i < 4; ++i) is_near[corners[i]] = 1;
    }
    for (int d = 0; d < darts; ++d)
      if (is_near[vertex[d]] || is_near[vertex[QuadComplex::next(d)]]) fails[polychords.of_dart[d]] = 0;
    may_not_go_.clear();
    for (int q = 0; q < darts; q += 4) {
      if (polychords.of_dart[q] == gone || polychords.of_dart[q + 1] == gone) continue;  // the others stay in their order
      for (int d = q; d < q + 4; ++d) may_not_go_.push_back(fails[polychords.of_dart[d]]);
    }
  }

  std::vector<char> may_not_go_;  ///< of darts: the row they are on
};

}  // namespace

int fit_quad_count(QuadComplex& complex, double wanted, double tolerance, const std::vector<char>& counted) {
  const double before = complex.quad_count();
  int changed = 0;
  RowRemoval removal(complex);
  for (;; ++changed) {
    const double count = complex.quad_count(), off = count - wanted;
    if (std::abs(off) <= tolerance) return changed;
    const double room = std::min(std::abs(off) + tolerance, kMostChange * before - std::abs(count - before));
    if (!(off > 0 ? removal.collapse_narrowest(complex, room, counted) : split_widest(complex, room, counted))) return changed;
  }
}

}  // namespace hybrid_quad
