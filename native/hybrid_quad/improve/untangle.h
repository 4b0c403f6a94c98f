#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/futile_mending.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Quads that are folded (scaled Jacobian <= 0) or look against the input all around them (inverted_quads). Ascending.
std::vector<int> tangled_quads(const Workpiece& piece, int threads = 1);

/// Where relaxing one ring failed, two rings, and so on: as many rounds as there are entries.
using FutileUntangling = std::array<FutileMending, 4>;

/// Untangles what is left, place by place: puts the free vertices around back on the surface, then relaxes rings that grow
/// from round to round, from a strong regularisation down. A place stays as it was where that does not help.
/// \param futile  by rings less one; where it failed before it need not be tried again
/// \returns number of tangled quads left
int untangle(Workpiece& piece, Smoother& smoother, const RunContext& context, FutileUntangling& futile);

}  // namespace hybrid_quad
