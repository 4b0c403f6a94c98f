#pragma once

#include <vector>

#include "hybrid_quad/frame_field/face_angles.h"
#include "hybrid_quad/working_surface/working_surface.h"

namespace hybrid_quad {

/// How frames turn from face to face beyond parallel transport so that they meet the surface's Gaussian curvature as it is on
/// average, not vertex by vertex: the angle defects of bumps, fins and ragged creases smaller than a quad cancel each other, and make no
/// cones. Curvature flows along edges from where there is more; frames turn by the flow as they cross an edge. Around a vertex off
/// features and borders the turns sum to the averaged curvature less the vertex's own.
/// \param spread  how far curvature is averaged, as a standard deviation in quad edges
/// \return 3 #F: counterclockwise, from the half-edge's face to the opposite one; 0 at edges that touch features or borders
std::vector<double> turns_for_average_curvature(const WorkingSurface& surface, const FaceAngles& angles, double spread);

}  // namespace hybrid_quad
