#pragma once

#include <vector>

#include "hybrid_quad/regular_quads/regular_quads.h"
#include "hybrid_quad/working_surface/working_surface.h"

namespace hybrid_quad {

/// Quads of the lengths asked for that fit on a patch: these may differ several times over from one end of it to the other.
/// \param pieces  of the overlay
double quads_by_area(const WorkingSurface& surface, const GridOverlay& overlay, const std::vector<int>& pieces);

}  // namespace hybrid_quad
