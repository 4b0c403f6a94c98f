#pragma once

#include "hybrid_quad/mesh/quad_mesh.h"

namespace hybrid_quad {

/// The last resort against quads without area (below 1e-10 of the squared mean edge length): a vertex or two of each move by a
/// ten thousandth of the mean edge so that it has one, on the side to which the quads around it point. Free vertices go first,
/// then those on curves. \returns number of quads opened
int open_flat_quads(QuadMesh& mesh);

}  // namespace hybrid_quad
