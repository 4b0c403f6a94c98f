#pragma once

#include "hybrid_quad/frame_field/frame_field.h"

namespace hybrid_quad::test {

/// A working surface made of a given mesh: its own features by angle, target length h everywhere.
WorkingSurface surface_of(TriangleMesh mesh, double h, double sharp_angle = 40);

/// Frames with the same rows (du, dv) in every face, projected to the face's plane.
FrameField constant_frames(const WorkingSurface& surface, const Vector3& du, const Vector3& dv);

/// Frames of a torus about the z axis (as torus() makes it): gradients of an angle coordinate that counts
/// `around` quads around the axis and one that counts `along` around the tube.
FrameField torus_frames(const WorkingSurface& surface, double around, double along, double major = 1);

/// The smoothest frames at 1 / h.
FrameField smooth_frames(const WorkingSurface& surface, double h);

/// The same frames with face f's turned by turns[f] quarters.
FrameField turned_frames(const WorkingSurface& surface, const FrameField& frames,
                         const std::vector<int>& turns);

}  // namespace hybrid_quad::test
