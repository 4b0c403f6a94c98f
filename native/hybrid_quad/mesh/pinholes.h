#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// For every vertex the vertex it is to be merged into (itself if none): all around a pinhole into one. A pinhole is a hole with a millionth of the
/// diagonal in extent, and a ten-thousandth of the edges that lead away from it: the pole of a surface of revolution with a vertex for each
/// meridian, at one place or, for rounding, around it.
/// \param positions  of a mesh whose diagonal is 1  \param open  what open_edges() gives
std::vector<int> closed_pinholes(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& triangles,
                                 const std::vector<std::array<int, 2>>& open);

}  // namespace hybrid_quad
