#pragma once

#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Coordinates about the origin and between -1 and 1, and the way back. The scale is a power of two, so that it costs no bit:
/// a surface and the same one twice as large have the same coordinates here, and what is computed from them is the same.
struct UnitFrame {
  Vector3 centre = Vector3::Zero();
  double scale = 1;

  Vector3 inward(const Vector3& p) const { return (p - centre) / scale; }
  Vector3 outward(const Vector3& p) const { return p * scale + centre; }
};

/// \param positions  finite  \param keep_origin  the origin stays where it is (mirror planes go through it)
UnitFrame unit_frame_of(const std::vector<Vector3>& positions, bool keep_origin);

}  // namespace hybrid_quad
