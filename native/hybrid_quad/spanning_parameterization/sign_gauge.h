#pragma once

#include "hybrid_quad/spanning_parameterization/lifted_grid.h"

namespace hybrid_quad {

/// Where rows of quads were moved one by one some jumps have an odd sum: Psi would change its sign across them. Moves the
/// values of vertices by whole quads, and the jumps with them, until all sums are even; what half-edges measure stays.
/// \return false, and nothing changed, where no values do that: somewhere a loop around a handle or a hole is odd
bool make_jumps_even(const TriangleMesh& mesh, LiftedGrid& grid);

/// Whether make_jumps_even would succeed.
bool can_make_jumps_even(const TriangleMesh& mesh, const LiftedGrid& grid);

}  // namespace hybrid_quad
