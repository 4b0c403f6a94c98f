#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// Lowers target lengths where the surface is a tube or a tip so thin that fewer than four quads would go around it
/// (docs/decisions/0005). Wide thin sheets are left alone. Thickness is the diameter of the largest ball inside that touches the
/// surface at a vertex (shrinking ball of Ma et al. 2012), measured at about four vertices a quad.
/// \param length  asked quad edge length (scene units)
/// \param target  #V, lowered in place to no less than least_ratio * length
void limit_lengths_of_thin_parts(const SurfaceIndex& index, double length, double least_ratio, std::vector<double>& target,
                                 const RunContext& context);

}  // namespace hybrid_quad
