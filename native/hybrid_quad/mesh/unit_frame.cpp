#include "hybrid_quad/mesh/unit_frame.h"

#include <cmath>

namespace hybrid_quad {

UnitFrame unit_frame_of(const std::vector<Vector3>& positions, bool keep_origin) {
  UnitFrame frame;
  if (positions.empty()) return frame;
  Vector3 low = positions.front(), high = positions.front();
  for (const Vector3& p : positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if (!keep_origin) frame.centre = 0.5 * low + 0.5 * high;
  const double size = (high - frame.centre).cwiseMax(frame.centre - low).maxCoeff();
  int exponent = 0;
  if (size > 0) std::frexp(size, &exponent);
  frame.scale = std::ldexp(1.0, exponent);
  return frame;
}

}  // namespace hybrid_quad
