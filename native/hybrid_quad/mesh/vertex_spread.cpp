#include "hybrid_quad/mesh/vertex_spread.h"

#include <algorithm>

namespace hybrid_quad {

VertexSpread spread_of(const std::vector<Vector3>& points) {
  std::vector<double> values(points.size());
  const auto nth = [&values](double share) {
    const std::size_t i = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values.end());
    return values[i];
  };
  VertexSpread spread;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = points[i][axis];
    spread.median[axis] = nth(0.5);
  }
  for (std::size_t i = 0; i < points.size(); ++i) values[i] = (points[i] - spread.median).cwiseAbs().maxCoeff();
  spread.usual = nth(0.9);
  return spread;
}

}  // namespace hybrid_quad
