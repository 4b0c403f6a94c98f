#pragma once

#include "hybrid_quad/singular_patches/patch_quads.h"

namespace hybrid_quad {

/// The patch with a vertex of value 0 in the middle of every inner edge that joins two border nodes of the
/// same sign: on such an edge neither of the two would be an extremum of its own.
PatchSurface split_node_chords(const PatchSurface& patch);

}  // namespace hybrid_quad
