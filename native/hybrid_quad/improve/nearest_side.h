#pragma once

#include <array>

#include "hybrid_quad/improve/edit_mesh.h"

namespace hybrid_quad {

/// Where a side of a quad is near a point.
struct SidePlace {
  int quad = -1, corner = 0;  ///< the side from this corner to the next
  double share = 0;           ///< of the way along it
  double distance = 0;        ///< scene units
};

/// The side nearest to p of the quads at some vertices, seen from the first of the two quads at it. What rounding alone tells apart goes
/// to the first quad, so that a surface that is turned gives the same.
/// \param vertices  one with quads at it or more
SidePlace nearest_side(const EditMesh& mesh, const Vector3& p, const std::array<int, 4>& vertices);
SidePlace nearest_side(const EditMesh& mesh, const Vector3& p, const std::array<int, 2>& vertices);

}  // namespace hybrid_quad
