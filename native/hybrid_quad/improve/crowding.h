#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Spreads out free vertices that are crowded in a spot (quads far smaller than those around, as a patch filled by
/// connectivity alone may have) by averaging neighbours on the surface. The corner energy would keep them there: it does
/// not see size, only shape. \pre the smoother's frames are those of the whole mesh
void spread_crowded(Workpiece& piece, const Smoother& smoother, const RunContext& context);

}  // namespace hybrid_quad
