#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Triangles of connected parts that lie on others, triangle on triangle, whichever way these face: a doubled mesh, or one with
/// a back to every face. Of two such parts that stays which is larger, or closed and facing outwards, or comes first.
/// \param faces  vertices of each; those at one place exactly count as one here, not for what is connected
/// \returns #F: whether it belongs to a part that is covered by others wholly
std::vector<char> copied_parts(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& faces);

}  // namespace hybrid_quad
