#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Triangles of a polygon by ear clipping in its best plane (Newell's normal); concave and slightly non-planar polygons
/// are fine, and a polygon that crosses itself still gives corner count - 2 triangles.
std::vector<std::array<int, 3>> triangulate_polygon(const std::vector<Vector3>& positions, const std::vector<int>& corners);

}  // namespace hybrid_quad
