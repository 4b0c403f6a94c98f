#pragma once

#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Of points on a surface, ones of which no two are nearer than both their distances, and none can be added. Points of sheets
/// that face away from each other do not count as near.
/// \param distance  #points, > 0
std::vector<int> evenly_spread(const std::vector<Vector3>& points, const std::vector<Vector3>& normals,
                               const std::vector<double>& distance);

}  // namespace hybrid_quad
