#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/frame_field/cross_hierarchy.h"

namespace hybrid_quad {

/// One step of diffusion over a time 1 / mass and renormalisation to |z| = 1 (MBO). Nodes whose value vanishes keep the
/// one they had. \param finest  the system with its rows  \param mass per node, > 0, in the units of `diagonal`
void diffuse_crosses(const CrossLevel& finest, const std::vector<double>& mass, std::vector<Complex>& z, const RunContext& context);

}  // namespace hybrid_quad
