#pragma once

#include "hybrid_quad/improve/flaw_measure.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Looks for other places of the vertices at quad q and then around it, one vertex after another: free ones among points of the
/// input around them and ahead of their neighbours, others along their curves. Where relaxing slides down into a fold, one that
/// looks further may not. Connectivity stays.
/// \returns whether fewer quads around are flawed, or as many and their shapes better; everything is as before otherwise
bool search_places(Workpiece& piece, Smoother& smoother, const FlawMeasure& measure, int q);

}  // namespace hybrid_quad
