#pragma once

#include <complex>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/frame_field/frame_field.h"

namespace hybrid_quad {

/// What pulls the crosses softly, face by face: weight times e^{4 i angle}, the angle from the face's half-edge 0. The
/// energy gets  sum over faces  2 area / h^2 |pull| |z - pull / |pull||^2, so a pull of 1 decides within a quad edge h.
/// From options.guides, and from the surface's own curvature where it bends one way more than the other.
/// \return #F, or empty where nothing pulls
std::vector<std::complex<double>> soft_pulls(const WorkingSurface& surface, const FrameFieldOptions& options,
                                             const RunContext& context);

/// How much a cross should turn from half-edge h's face to the opposite one, beyond parallel transport, for quads of the
/// surface's target lengths to fit together: grad(angle) = J grad(log length), integrated across the edge. It is what
/// parallel transport of the metric scaled by 1 / length^2 adds.
/// \return 3 #F, opposite signs on the two sides; 0 on features and the boundary
std::vector<double> turns_for_lengths(const WorkingSurface& surface);

}  // namespace hybrid_quad
