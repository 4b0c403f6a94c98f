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

bool collapse_narrowest(QuadComplex& complex, double room, const std::vector<char>& counted) {
  const Polychords polychords = trace_polychords(complex);
  for (const Row& row : rows_of(complex, polychords, counted))
    if (row.length <= room && collapse_polychord(complex, polychords, row.id)) return true;
  return false;
}

}  // namespace

int fit_quad_count(QuadComplex& complex, double wanted, double tolerance, const std::vector<char>& counted) {
  const double before = complex.quad_count();
  int changed = 0;
  for (;; ++changed) {
    const double count = complex.quad_count(), off = count - wanted;
    if (std::abs(off) <= tolerance) return changed;
    const double room = std::min(std::abs(off) + tolerance, kMostChange * before - std::abs(count - before));
    if (!(off > 0 ? collapse_narrowest(complex, room, counted) : split_widest(complex, room, counted))) return changed;
  }
}

}  // namespace hybrid_quad
