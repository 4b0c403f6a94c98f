#pragma once

#include <vector>

#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

struct SelfIntersections {
  std::vector<int> faces;   ///< ascending
  bool is_complete = true;  ///< false: the search ended before every pair of faces near each other was looked at
};

/// Faces that another face of the mesh cuts through, or lies upon with a common area: two neighbours folded flat onto each
/// other, two sheets in one place. Faces that only touch at a point or along a line are not among them, as far as rounding
/// can tell. Of size 1 or so the mesh should be (see UnitFrame). The search ends after as many pairs as a
/// hundred times the faces and ten million, as where thousands of faces lie about one place.
SelfIntersections self_intersecting_faces(const SurfaceIndex& index);

}  // namespace hybrid_quad
