#pragma once

#include <vector>

#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// Faces that another face of the mesh cuts through, or lies upon with a common area: two neighbours folded flat onto each
/// other, two sheets in one place. Faces that only touch at a point or along a line are not among them, as far as rounding
/// can tell. Of size 1 or so the mesh should be (see UnitFrame). Ascending. The search ends after as many pairs as a
/// hundred times the faces and ten million: where thousands of faces lie about one place, some may not be told.
std::vector<int> self_intersecting_faces(const SurfaceIndex& index);

}  // namespace hybrid_quad
