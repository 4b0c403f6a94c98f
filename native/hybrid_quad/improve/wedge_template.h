#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Gives a second quad to vertices in the middle of a curve that have a single, straight-cornered one, where no move of
/// the valence search can: a quad (a, v, b, c) with a, v, b on the feature and its neighbour (c, b, x, y) across b c become
/// (a, v, m, c), (v, b, n, m), (m, n, y, c), (b, x, y, n) with new vertices m, n of valence three; only y gets one
/// quad more. Where features leave no room for that, four quads around the folded one.
/// \returns number of places changed
int open_straight_corners(Workpiece& piece, Smoother& smoother, const RunContext& context);

}  // namespace hybrid_quad
