#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/spanning_parameterization/movable_grid.h"
#include "hybrid_quad/spanning_parameterization/spanning_parameterization.h"

namespace hybrid_quad {

/// For the dislocations that cannot move as a whole, because features cross the way of both their parts: a dislocation is
/// the end of two rows of quads, one of each grid direction, and each may go its own way, over features along which it
/// slides. Done only where in the end every face and cone holds whole dislocations again and Psi keeps its sign around
/// all loops; after that the jumps are in D2 as before. Beyond the paper, which leaves these to the Morse complex.
void cancel_row_ends(const SpanningOptions& options, const RunContext& context, MovableGrid& movable);

}  // namespace hybrid_quad
