#include "hybrid_quad/mesh/quad_count.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Rows taken out together: apart from each other, so that each goes as it would alone.
class RowsApart {
 public:
  RowsApart(const QuadComplex& complex, const Polychords& polychords)
      : complex_(complex), darts_of_(polychords.length.size()), is_at_taken_(complex.positions.size(), 0),
        is_taken_(complex.quad_count(), 0), chosen_(polychords.length.size(), 0) {
    for (int d = 0; d < static_cast<int>(polychords.of_dart.size()); ++d) darts_of_[polychords.of_dart[d]].push_back(d);
  }

  bool crosses(int row) const { return any(row, [&](int d) { return is_taken_[d / 4] != 0; }); }
  bool touches(int row) const { return any(row, [&](int d) { return is_at_taken_[complex_.from(d)] || is_at_taken_[complex_.to(d)]; }); }
  const std::vector<char>& chosen() const { return chosen_; }  ///< by row

  void take(int row) {
    chosen_[row] = 1;
    for (const int d : darts_of_[row]) is_taken_[d / 4] = is_at_taken_[complex_.from(d)] = is_at_taken_[complex_.to(d)] = 1;
  }

 private:
  template <class Test>
  bool any(int row, const Test& test) const {
    return std::any_of(darts_of_[row].begin(), darts_of_[row].end(), test);
  }

  const QuadComplex& complex_;
  std::vector<std::vector<int>> darts_of_;
  std::vector<char> is_at_taken_, is_taken_, chosen_;
};

/// Takes out the narrowest row, then the next, and so on. One that may not go is tried again only when something changed beside it:
/// surfaces with many handles have thousands of rows, and hardly one that may go. Where many may, several go at once.
class RowRemoval {
 public:
  explicit RowRemoval(const QuadComplex& complex) : may_not_go_(complex.opposite.size(), 0) {}

  /// \param surplus  quads too many: no further row where the rows have as many
  /// \param room  no more quads than this
  /// \return rows taken out
  int collapse_narrowest(QuadComplex& complex, double surplus, double room, const std::vector<char>& counted) {
    const Polychords polychords = trace_polychords(complex);
    std::vector<char> fails(polychords.length.size(), 0);
    for (std::size_t d = 0; d < may_not_go_.size(); ++d)
      if (may_not_go_[d]) fails[polychords.of_dart[d]] = 1;
    std::vector<Row> rows = rows_of(complex, polychords, counted);
    rows.erase(std::remove_if(rows.begin(), rows.end(), [&](const Row& row) { return row.length > room || fails[row.id]; }), rows.end());
    const std::vector<int> vertex = complex.vertex;
    for (std::size_t first = 0; first < rows.size(); ++first) {
      for (int most = std::numeric_limits<int>::max(); most > 0; most /= 2) {  // half of them where one may not go
        RowsApart gone(complex, polychords);
        most = choose(rows, first, most, surplus, room, gone);
        if (!collapse_polychords(complex, polychords, gone.chosen())) continue;
        remember(vertex, polychords, gone.chosen(), fails);
        return most;
      }
      fails[rows[first].id] = 1;
    }
    return 0;
  }

 private:
  /// A row and, of those that follow, what would go next if they went one by one: narrower than any that crosses a chosen one, and
  /// hardly wider than the first, as what lies beside a row that goes grows wider.
  static int choose(const std::vector<Row>& rows, std::size_t first, int most, double surplus, double room, RowsApart& gone) {
    constexpr double kMostWider = 0.2;  // in logarithms; what lies beside one that goes grows by .4
    gone.take(rows[first].id);
    int count = 1;
    double quads = rows[first].length;
    for (std::size_t i = first + 1; count < most && i < rows.size() && quads < surplus; ++i) {
      if (rows[i].width > rows[first].width + kMostWider || gone.crosses(rows[i].id)) break;
      if (gone.touches(rows[i].id) || quads + rows[i].length > room) continue;
      gone.take(rows[i].id);
      quads += rows[i].length;
      ++count;
    }
    return count;
  }

  /// What fails far from the row that went still does: whether a row may go depends on the quads around its vertices, and on the
  /// number of edges of curves, which only falls.
  /// \param vertex, polychords  of the complex before
  /// \param gone  by row
  void remember(const std::vector<int>& vertex, const Polychords& polychords, const std::vector<char>& gone, std::vector<char>& fails) {
    const int darts = static_cast<int>(vertex.size());
    const std::size_t vertices = vertex.empty() ? 0 : 1 + *std::max_element(vertex.begin(), vertex.end());
    std::vector<char> moved(vertices, 0), is_near(vertices, 0);
    for (int d = 0; d < darts; ++d)
      if (gone[polychords.of_dart[d]]) moved[vertex[d]] = moved[vertex[QuadComplex::next(d)]] = 1;
    for (int q = 0; q < darts; q += 4) {
      const auto corners = vertex.begin() + q;
      if (std::any_of(corners, corners + 4, [&](int v) { return moved[v] != 0; }))
        for (int i = 0; i < 4; ++i) is_near[corners[i]] = 1;
    }
    for (int d = 0; d < darts; ++d)
      if (is_near[vertex[d]] || is_near[vertex[QuadComplex::next(d)]]) fails[polychords.of_dart[d]] = 0;
    may_not_go_.clear();
    for (int q = 0; q < darts; q += 4) {
      if (gone[polychords.of_dart[q]] || gone[polychords.of_dart[q + 1]]) continue;  // the others stay in their order
      for (int d = q; d < q + 4; ++d) may_not_go_.push_back(fails[polychords.of_dart[d]]);
    }
  }

  std::vector<char> may_not_go_;  ///< of darts: the row they are on
};

}  // namespace

int fit_quad_count(QuadComplex& complex, double wanted, double tolerance, const std::vector<char>& counted, const RunContext& context) {
  const double before = complex.quad_count();
  int changed = 0;
  RowRemoval removal(complex);
  for (;;) {
    context.checkpoint();
    const double count = complex.quad_count(), off = count - wanted;
    if (std::abs(off) <= tolerance) return changed;
    const double room = std::min(std::abs(off) + tolerance, kMostChange * before - std::abs(count - before));
    const int now = off > 0 ? removal.collapse_narrowest(complex, off - tolerance, room, counted) : split_widest(complex, room, counted);
    if (now == 0) return changed;
    changed += now;
  }
}

}  // namespace hybrid_quad
