#pragma once

#include <cstdint>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/frame_field/face_angles.h"

namespace hybrid_quad {

/// How a frame turns from half-edge h's face to the opposite one: quarters that only rename its axes, and the rest.
struct FrameTurn {
  int quarters = 0;   ///< (u, v) over there = turned((u, v) here, quarters), wrapped to 0..3
  double angle = 0;   ///< rotation of the frame as a cross, counterclockwise, within pi/4 of what is expected
};

/// Direction of every frame's u axis, counterclockwise from its face's half-edge 0: the rotation nearest to the frame.
/// Frames that say nothing (zero, not finite, orientation reversed) are taken along half-edge 0.
std::vector<double> frame_directions(const TriangleMesh& mesh, const std::vector<Vector3>& du, const std::vector<Vector3>& dv,
                                     const RunContext& context = {});

/// The turn nearest to the expected one. \pre h is interior
FrameTurn turn_across(const TriangleMesh& mesh, const FaceAngles& angles, const std::vector<double>& directions, int h);

/// The turn that goes with a given matching, in [-pi, pi]: frames that were changed after they were matched.
FrameTurn turn_across(const FaceAngles& angles, const std::vector<double>& directions, int h, int opposite, int quarters);

/// Quarters of a turn that the field makes at vertex v. Interior: +1 where three quads meet, -1 where five do. Boundary:
/// 2 minus the quads' corners there. 0 for an isolated vertex.
/// \param matching  3 #F, as in FrameField; null: the nearest turns
int quarters_at(const TriangleMesh& mesh, const FaceAngles& angles, const std::vector<double>& directions, int v,
                const std::vector<std::uint8_t>* matching = nullptr);

/// Of every vertex; they sum to 4 times the Euler characteristic.
std::vector<int> vertex_quarters(const TriangleMesh& mesh, const FaceAngles& angles, const std::vector<double>& directions,
                                 const std::vector<std::uint8_t>* matching = nullptr, const RunContext& context = {});

/// Quads that the field puts at a vertex between half-edge `first`, which leaves it, and the next marked one
/// counterclockwise: all around where no other is marked, to the boundary where that comes first. 0 at an acute tip.
/// \param is_marked  3 #F: where sectors end, as at features
int sector_quarters(const TriangleMesh& mesh, const FaceAngles& angles, const std::vector<double>& directions, int first,
                    const std::vector<char>& is_marked);

}  // namespace hybrid_quad
