#pragma once

#include <vector>

#include "hybrid_quad/frame_field/face_angles.h"
#include "hybrid_quad/working_surface/working_surface.h"

namespace hybrid_quad {

/// Turns frames around inner vertices of index beyond +-1 quarter so that single quarters move to a neighbouring
/// vertex: two quads cannot meet alone, and Psi has no value at a vertex of even index. Frames at features stay.
/// \param directions  #F, of the frames' u axes from half-edge 0; changed
/// \return number of vertices left beyond +-1 (no neighbour could take a quarter)
int split_strong_cones(const WorkingSurface& surface, const FaceAngles& angles, std::vector<double>& directions);

/// Turns frames a little where neighbouring vertices off features have opposite indices, so that they have none.
/// \return how many pairs are gone
int cancel_cones(const WorkingSurface& surface, const FaceAngles& angles, std::vector<double>& directions);

}  // namespace hybrid_quad
