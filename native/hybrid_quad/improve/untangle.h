#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Quads that are folded (scaled Jacobian <= 0) or look against the input all around them (inverted_quads). Ascending.
std::vector<int> tangled_quads(const Workpiece& piece, int threads = 1);

/// Untangles what is left, place by place: puts the free vertices around back on the surface, then relaxes rings that grow
/// from round to round, from a strong regularisation down. A place stays as it was where that does not help.
/// \returns number of tangled quads left
int untangle(Workpiece& piece, Smoother& smoother, const RunContext& context);

}  // namespace hybrid_quad
