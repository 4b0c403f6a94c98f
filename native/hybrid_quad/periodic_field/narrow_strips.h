#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/periodic_field/grid_measure.h"

namespace hybrid_quad {

/// Where two features run side by side less than one quad apart, no row of quads would fit between them, and
/// their isolines would coincide. Stretches the measure across such strips, face by face, so that they are
/// one quad wide. \param measure  as the frames measure; `axis` is known
void widen_narrow_strips(const TriangleMesh& mesh, const FrameField& frames, GridMeasure& measure);

/// An edge of a chain from one feature straight across a strip to the next: the strip's width in quads is the
/// sum over its chain of (share . what the half-edge measures).
struct StripEdge {
  int halfedge;
  std::array<int, 2> share;  ///< a unit vector in the gauge of the half-edge's face
};

/// One chain from each side of every feature edge that has a parallel feature within `widest` quads.
std::vector<std::vector<StripEdge>> find_strips(const TriangleMesh& mesh, const FrameField& frames,
                                                const GridMeasure& measure, double widest);

}  // namespace hybrid_quad
