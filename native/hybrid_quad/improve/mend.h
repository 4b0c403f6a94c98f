#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/futile_mending.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

/// What was done, in numbers of changes.
struct MendReport {
  int mended = 0;  ///< that only flawed quads called for
  int placed = 0;  ///< around quads of poor shape
};

/// The last resort for quads that are flawed (quality.h) when all else is done: other positions or other neighbours, whatever
/// valences and shapes suffer, if only fewer quads around are flawed. Then other positions around quads whose scaled Jacobian
/// is below FlawMeasure::kFair.
/// \param whole, agreement  the surface to measure by, and the other parameter of flawed_quads
MendReport mend_flawed(Workpiece& piece, Smoother& smoother, const SurfaceIndex& whole, const Agreement& agreement,
                       const RunContext& context);

/// The first half of that, for some quads only.
/// \param quads  what is to be mended
/// \param futile  where it is in vain; more of these are remembered
/// \returns number of changes
int mend_listed(Workpiece& piece, Smoother& smoother, const SurfaceIndex& whole, const Agreement& agreement, const RunContext& context,
                const std::vector<int>& quads, FutileMending& futile);

}  // namespace hybrid_quad
