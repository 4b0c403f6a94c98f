#pragma once

#include "hybrid_quad/working_surface/working_surface.h"

namespace hybrid_quad {

/// How many steps of averaging with neighbours spread a value on the surface as far as asked, bounded.
/// \param spread  standard deviation along a direction, in quad edges
/// \param step    of one step, in edges of the surface
int averaging_steps(const WorkingSurface& surface, double spread, double step);

}  // namespace hybrid_quad
