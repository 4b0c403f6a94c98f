#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/trial.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Fills convex patches around irregular vertices anew where that takes fewer of them, by the patterns of patch_pattern.h;
/// each kept only if the quads are about as good afterwards (locally smoothed). Features, the boundary and all that lies outside a
/// patch stay as they are.
/// \returns number of patches filled anew
int requadrangulate_patches(Workpiece& piece, Smoother& smoother, const RunContext& context);

/// Fills a patch around v anew, with up to two irregular vertices more than it has, so that what `measure` says of the quads there
/// (see Trial) grows by `gain`. \returns whether one was
bool requadrangulate_around(Workpiece& piece, Smoother& smoother, int v, const Trial::Measure& measure, double gain);

}  // namespace hybrid_quad
