#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Triangles without area that hang together, are joined to faces with area along one edge or several in a row, and stick out beyond their
/// ends: whiskers of the surface. No flip or collapse removes them, and split at vertices that they pass they would be sewn to other parts.
/// \returns #F: whether it is part of one
std::vector<char> whiskers(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& triangles);

}  // namespace hybrid_quad
