#include "hybrid_quad/mesh/pinholes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hybrid_quad/base/disjoint_sets.h"

namespace hybrid_quad {

namespace {

/// Open edges that hang together.
struct Rim {
  Vector3 low = Vector3::Constant(HUGE_VAL), high = Vector3::Constant(-HUGE_VAL);
  double shortest_spoke = HUGE_VAL;  ///< of the edges that lead away from it
  double extent() const { return (high - low).norm(); }
};

}  // namespace

std::vector<int> closed_pinholes(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& triangles,
                                 const std::vector<std::array<int, 2>>& open) {
  constexpr double kExtent = 1e-6, kExtentOfSpoke = 1e-4;
  DisjointSets sets(positions.size());
  for (const auto& [a, b] : open) sets.join(a, b);
  std::vector<Rim> rims;
  std::vector<int> rim_of(positions.size(), -1);  // by the first vertex, then by any
  for (const auto& e : open)
    for (const int v : e) {
      int& rim = rim_of[sets.set_of(v)];
      if (rim < 0) {
        rim = static_cast<int>(rims.size());
        rims.emplace_back();
      }
      rim_of[v] = rim;
      rims[rim].low = rims[rim].low.cwiseMin(positions[v]);
      rims[rim].high = rims[rim].high.cwiseMax(positions[v]);
    }
  std::vector<int> target(positions.size());
  std::iota(target.begin(), target.end(), 0);
  if (std::none_of(rims.begin(), rims.end(), [](const Rim& rim) { return rim.extent() <= kExtent; })) return target;
  for (const auto& t : triangles)
    for (int i = 0; i < 3; ++i) {
      const int v = t[i], w = t[(i + 1) % 3];
      if (rim_of[v] == rim_of[w]) continue;
      const double length = (positions[w] - positions[v]).norm();
      for (const int rim : {rim_of[v], rim_of[w]})
        if (rim >= 0) rims[rim].shortest_spoke = std::min(rims[rim].shortest_spoke, length);
    }
  const auto is_pinhole = [&](const Rim& rim) {
    return rim.extent() <= kExtent && std::isfinite(rim.shortest_spoke) && rim.extent() <= kExtentOfSpoke * rim.shortest_spoke;
  };
  for (const auto& e : open)
    for (const int v : e)
      if (is_pinhole(rims[rim_of[v]])) target[v] = sets.set_of(v);
  return target;
}

}  // namespace hybrid_quad
