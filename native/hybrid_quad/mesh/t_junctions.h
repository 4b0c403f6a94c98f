#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Splits triangles at vertices that lie inside one of their open edges and are themselves ends of open edges, so that
/// cracks of zero width close; none where there are more than 20000 open edges.
/// \param polygon  one value a triangle, copied to its parts \return the vertices split at
std::vector<int> split_at_t_junctions(const std::vector<Vector3>& positions, double tolerance,
                                      std::vector<std::array<int, 3>>& triangles, std::vector<int>& polygon);

}  // namespace hybrid_quad
