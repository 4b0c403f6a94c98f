#pragma once

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

/// Quads that are longer along thin tubes and tips than around them (docs/decisions/0053): the shorter their edges are asked to be the longer
/// they are drawn, so that edges along tend to the usual length. Asked lengths h are those of squares with as much area.
struct ThinStretch {
  double length = 0;  ///< usual edge length, from which on quads are squares (scene units)
  double most = 1;    ///< longer over shorter side

  bool is_any() const { return most > 1; }
  double ratio(double h) const { return std::clamp((length / h) * (length / h), 1.0, most); }
  double across(double h) const { return h / std::sqrt(ratio(h)); }
  /// The asked length that has edges so short across.
  double with_across(double edge) const {
    if (edge >= length) return edge;
    return edge * most >= length ? std::sqrt(edge * length) : edge * std::sqrt(most);
  }
};

}  // namespace hybrid_quad
