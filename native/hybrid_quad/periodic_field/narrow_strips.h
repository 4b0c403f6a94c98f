#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/periodic_field/grid_measure.h"

namespace hybrid_quad {

/// Where two features run side by side less than `rows` quads apart, fewer rows of quads would fit between them, or none,
/// and their isolines would coincide. Stretches the measure across such strips, face by face, so that they are that many
/// quads wide, and one where more would be slivers.
/// \param measure  as the frames measure; `axis` is known  \param rows  1 or 2
void widen_narrow_strips(const TriangleMesh& mesh, const FrameField& frames, int rows, GridMeasure& measure);

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
