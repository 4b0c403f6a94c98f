#include <algorithm>
#include <cmath>

#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/mesh/segment_index.h"

namespace hybrid_quad {

namespace {

/// Indices of a longest strictly increasing subsequence.
std::vector<int> longest_increasing(const std::vector<double>& values) {
  std::vector<int> tails, before(values.size(), -1);
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    const auto place = std::lower_bound(tails.begin(), tails.end(), values[i], [&](int t, double x) { return values[t] < x; });
    if (place != tails.begin()) before[i] = *(place - 1);
    if (place == tails.end())
      tails.push_back(i);
    else
      *place = i;
  }
  std::vector<int> kept;
  for (int i = tails.empty() ? -1 : tails.back(); i >= 0; i = before[i]) kept.push_back(i);
  std::reverse(kept.begin(), kept.end());
  return kept;
}

std::vector<double> nearest_arc_lengths(const CurveGeometry& curve, const std::vector<Vector3>& points) {
  std::vector<std::array<Vector3, 2>> segments;
  for (std::size_t i = 0; i + 1 < curve.points().size(); ++i) segments.push_back({curve.points()[i], curve.points()[i + 1]});
  const SegmentIndex index(std::move(segments));
  std::vector<double> arcs;
  for (const Vector3& p : points) {
    const SegmentPoint near = index.nearest(p);
    arcs.push_back(near.segment < 0 ? 0.0 : curve.arc_length(near.segment, near.fraction));
  }
  return arcs;
}

/// Keeps the values that are in order between `low` and `high` and spreads the others evenly between their neighbours;
/// no two closer than a twentieth of the mean spacing.
void put_in_order(std::vector<double>& values, double low, double high) {
  const int n = static_cast<int>(values.size());
  std::vector<int> kept = longest_increasing(values);
  int k = 0;
  double left = low;
  for (int i = 0; i < n;) {
    while (k < static_cast<int>(kept.size()) && kept[k] < i) ++k;
    const int stop = k < static_cast<int>(kept.size()) ? kept[k] : n;
    const double right = stop < n ? values[stop] : high;
    for (int j = i; j < stop; ++j) values[j] = left + (right - left) * (j - i + 1) / (stop - i + 1);
    if (stop < n) left = values[stop];
    i = stop + 1;
  }
  const double least = 0.05 * (high - low) / (n + 1);
  double floor = low;
  for (double& x : values) floor = x = std::max(x, floor + least);
  double ceiling = high;
  for (int i = n - 1; i >= 0; --i) ceiling = values[i] = std::min(values[i], ceiling - least);
}

std::vector<double> closed_arc_lengths(const CurveGeometry& curve, const std::vector<double>& nearest) {
  const int n = static_cast<int>(nearest.size());
  const auto from_start = [&](int start) {
    std::vector<double> ahead;
    for (int i = 1; i < n; ++i) ahead.push_back(curve.normalized(nearest[(start + i) % n] - nearest[start]));
    return ahead;
  };
  // A first vertex at a wrong place would put the whole chain out of order: take the start that most others agree with.
  constexpr int kTries = 8;
  int best_start = 0;
  std::size_t most = 0;
  for (int t = 0; t < std::min(kTries, n); ++t) {
    const int start = static_cast<int>(static_cast<long long>(t) * n / std::min(kTries, n));
    const std::size_t agreeing = longest_increasing(from_start(start)).size();
    if (t == 0 || agreeing > most) {
      most = agreeing;
      best_start = start;
    }
  }
  std::vector<double> ahead = from_start(best_start);
  put_in_order(ahead, 0, curve.length());
  std::vector<double> arcs(n);
  arcs[best_start] = curve.normalized(nearest[best_start]);
  for (int i = 1; i < n; ++i) arcs[(best_start + i) % n] = curve.normalized(nearest[best_start] + ahead[i - 1]);
  return arcs;
}

}  // namespace

std::vector<double> chain_arc_lengths(const CurveGeometry& curve, const std::vector<Vector3>& points, bool at_ends) {
  std::vector<double> arcs = nearest_arc_lengths(curve, points);
  if (curve.closed()) return closed_arc_lengths(curve, arcs);
  if (!at_ends || points.size() < 2) {
    put_in_order(arcs, 0, curve.length());
    return arcs;
  }
  std::vector<double> inner(arcs.begin() + 1, arcs.end() - 1);
  put_in_order(inner, 0, curve.length());
  arcs.front() = 0;
  arcs.back() = curve.length();
  std::copy(inner.begin(), inner.end(), arcs.begin() + 1);
  return arcs;
}

}  // namespace hybrid_quad
