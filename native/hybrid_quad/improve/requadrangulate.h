#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Fills convex patches around irregular vertices anew where that takes fewer of them, by the patterns of patch_pattern.h;
/// each kept only if the quads are about as good afterwards (locally smoothed). Features, the boundary and all that lies outside a
/// patch stay as they are.
/// \returns number of patches filled anew
int requadrangulate_patches(Workpiece& piece, Smoother& smoother, const RunContext& context);

}  // namespace hybrid_quad
