#pragma once

#include "hybrid_quad/periodic_field/grid_measure.h"

namespace hybrid_quad {

/// Where two features run side by side less than one quad apart, no row of quads would fit between them, and their
/// isolines would coincide. Stretches the measure across such strips, face by face, so that they are one quad wide.
/// \param measure  as the frames measure; `axis` is known
void widen_narrow_strips(const TriangleMesh& mesh, const FrameField& frames, GridMeasure& measure);

}  // namespace hybrid_quad
