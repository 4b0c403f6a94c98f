#pragma once

#include "hybrid_quad/frame_field/cross_hierarchy.h"

namespace hybrid_quad {

/// Multilevel minimiser: the coarsest level is solved as a linear system (or for the lowest eigenvector when nothing
/// pulls), and on the way to the finest every level is relaxed with |z| = 1 by nonlinear Gauss-Seidel. Near-linear time.
/// \param sweeps  of the finest level; coarser ones, which cost less, get more
std::vector<Complex> relax_crosses(const std::vector<CrossLevel>& levels, int sweeps, const RunContext& context);

}  // namespace hybrid_quad
