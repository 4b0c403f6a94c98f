#pragma once

#include <vector>

#include "hybrid_quad/frame_field/face_angles.h"
#include "hybrid_quad/working_surface/working_surface.h"

namespace hybrid_quad {

/// How frames are expected to turn around an acute tip, where two straight features or borders meet at half a right angle or so,
/// for one quad to begin there. A smooth field is indifferent at 45 degrees whether the sides of the tip are two sides of a quad or
/// the same one, but in the second case rows of quads of one size end all along the tip. Frames turn as if the tip were
/// wider, all of it at its end and less the farther from there, up to the length of its shorter side (docs/decisions/0032).
/// \return 3 #F: counterclockwise, from the half-edge's face to the opposite one
std::vector<double> turns_that_open_tips(const WorkingSurface& surface, const FaceAngles& angles);

}  // namespace hybrid_quad
