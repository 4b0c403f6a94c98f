#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Spreads out free vertices that are crowded in a spot (quads far smaller than those around, as a patch filled by
/// connectivity alone may have) by averaging neighbours on the surface. The corner energy would keep them there: it does
/// not see size, only shape.
void spread_crowded(Workpiece& piece, const RunContext& context);

/// Removes quads far smaller than the target in every direction by collapsing diagonals, as long as valences allow: what
/// a fill made too dense. \returns number of quads removed
int remove_crowded(Workpiece& piece, const RunContext& context);

}  // namespace hybrid_quad
