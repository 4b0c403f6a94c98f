#pragma once

#include "hybrid_quad/mesh/quad_complex.h"
#include "hybrid_quad/singular_patches/singular_patches.h"

namespace hybrid_quad {

/// Glues regular quads and patches along their common grid edges into one complex. An edge is known by the overlay
/// half-edges it is made of, a vertex is an orbit of the gluing: nothing is identified by position.
/// \throws InternalError if two neighbours disagree about a grid edge or a vertex
QuadComplex assemble_quads(const WorkingSurface& surface, const RegularQuads& regular, const SingularPatches& singular);

}  // namespace hybrid_quad
