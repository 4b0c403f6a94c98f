#pragma once

#include <algorithm>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// What changing frames costs: row r of X_f is node 2 f + r.
struct CorrectionCosts {
  std::vector<Vector2> stiffness;  ///< per node: weights of the row of (X - I)^2, without lambda
  std::vector<int> feature;        ///< per node: the half-edge of its face that the row has to vanish on, or -1
  std::vector<double> area;        ///< #F, over the mean one
  double feature_weight = 1;       ///< of a feature's squared transversal part, beside an edge's squared curl

  /// How soft the demand is that a vector of the grid measures the same from both sides, or nothing across a feature.
  static double softness(const Vector2& measured, double weight) { return std::max(measured.squaredNorm(), 1e-12) / weight; }
  double edge_weight(int f, int g) const { return (area[f] + area[g]) / 3 + 1e-4; }
};

}  // namespace hybrid_quad
