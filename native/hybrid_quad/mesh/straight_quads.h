#pragma once

#include "hybrid_quad/mesh/quad_complex.h"

namespace hybrid_quad {

/// A quad with three sides on feature curves and no corner at the two vertices between them has two angles of 180
/// degrees, whatever its vertices do (the paper's known weakness, at its worst). Puts a strip of three quads along the
/// three sides: two new vertices inside, where the quad and its neighbour across the fourth side were.
/// \return how many were opened
int open_straight_quads(QuadComplex& complex);

}  // namespace hybrid_quad
