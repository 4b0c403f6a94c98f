#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Triangles of a polygon, corner count - 2 of them, by ear clipping in its best plane (Newell's normal); concave and slightly
/// non-planar polygons are fine. One that has no surface of its own, because it crosses or touches itself in that plane or is bent,
/// gets the one that most readers give it, a fan.
/// \param first  the fan's corner: index into `corners`
std::vector<std::array<int, 3>> triangulate_polygon(const std::vector<Vector3>& positions, const std::vector<int>& corners, int first = 0);

/// Lets a polygon begin at the corner farthest from a point, of several as far at the first of them: of equal ears (a
/// parallelogram has two ways to be cut) triangulate_polygon takes that of the first corner, however the polygon lies in space.
void begin_far_from(const Vector3& point, const std::vector<Vector3>& positions, std::vector<int>& corners);

}  // namespace hybrid_quad
