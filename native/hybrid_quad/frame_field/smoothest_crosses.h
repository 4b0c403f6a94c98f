#pragma once

#include "hybrid_quad/frame_field/cross_hierarchy.h"

namespace hybrid_quad {

/// The minimiser without |z| = 1 (globally optimal directions: Knoeppel et al. 2013), scaled to |z| = 1 at the end: of the
/// linear system where something pulls, else the smallest eigenvector. Solved on the finest level that a direct solver
/// finds small, and carried on to the finest by linear relaxation.
/// \param sweeps  of every level
std::vector<Complex> smoothest_crosses(const std::vector<CrossLevel>& levels, int sweeps, const RunContext& context);

}  // namespace hybrid_quad
