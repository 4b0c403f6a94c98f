#pragma once

#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Where nearly all of some points are.
struct VertexSpread {
  Vector3 median = Vector3::Zero();
  double usual = 0;  ///< nine tenths of the points are no farther from the median, along any axis

  /// How many times farther than usual a point is; 0 where all but a few are in one place.
  double ratio(const Vector3& p) const { return usual > 0 ? (p - median).cwiseAbs().maxCoeff() / usual : 0; }
};

/// \param points  finite, at least one
VertexSpread spread_of(const std::vector<Vector3>& points);

}  // namespace hybrid_quad
