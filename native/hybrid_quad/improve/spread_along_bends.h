#pragma once

#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Moves vertices along feature curves so that the largest distance from a curve to its chain of edges shrinks, as far as the
/// quads beside it bear that; free vertices nearby follow. The smoother evens out by curvature and weighs that against shape, which
/// leaves the one edge that is too long; here it is the largest deviation that counts. In rounds, which share what quads may lose.
/// \returns number of changes to a chain
int spread_along_bends(Workpiece& piece, Smoother& smoother, const RunContext& context);

}  // namespace hybrid_quad
