#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "hybrid_quad/frame_field/face_angles.h"
#include "hybrid_quad/working_surface/working_surface.h"

namespace hybrid_quad {

/// One of the two solutions that are compared.
struct FieldSolution {
  int quarters = 0;   ///< sum of |index| over the vertices inside, on features and off them
  double energy = 0;  ///< what is minimised, but for a constant that both have
};

/// How the field was chosen.
struct FieldChoice {
  FieldSolution relaxed;    ///< relaxed level by level with |z| = 1
  FieldSolution smoothest;  ///< from the smoothest field without |z| = 1; the relaxed one where lengths are asked for
  int kept = 0;             ///< 0: relaxed, 1: smoothest
};

/// One frame per face, given by the rows of F^{-1}: an edge e of face f measures (du[f] . e, dv[f] . e) quads. Frames
/// are combed: matchings are 0 across a spanning tree of the dual graph.
struct FrameField {
  std::vector<Vector3> du, dv;          ///< #F, in the face's plane, det > 0 (du x dv along the normal); 1 / scene units
  std::vector<std::uint8_t> matching;   ///< 3 #F: (u, v) in the gauge of opposite(h)'s face = turned((u, v) in h's face, matching[h])
  std::vector<std::int8_t> cone_index;  ///< #V, quarters of a turn: +1 where three quads meet, -1 where five do; 0 on features
  int feature_cones = 0;                ///< irregular vertices that features force: see count_feature_cones
  FieldChoice choice;

  /// (du, dv) along half-edge h, measured in the frame of its face.
  Vector2 grid_vector(const TriangleMesh& mesh, int h) const {
    const Vector3 e = mesh.edge_vector(h);
    return {du[h / 3].dot(e), dv[h / 3].dot(e)};
  }
  int cone_count() const { return static_cast<int>(cone_index.size() - std::count(cone_index.begin(), cone_index.end(), 0)); }
  /// The fewest vertices inside the surface at which other than four quads meet, on features too.
  int singularity_count() const { return cone_count() + feature_cones; }
};

struct FrameFieldOptions {
  int sweeps = 10;         ///< relaxation sweeps of the finest level
  int coarsest = 300;      ///< unknowns of the level that is solved directly
  /// How far the surface's curvature is averaged, in quad edges: detail that is smaller makes no cones.
  double curvature_spread = 1;
  /// Diffusion afterwards, in squared quad edges, one step each.
  std::vector<double> diffusion_times{1.0, 1.0, 1.0};
  /// Likewise for the other solution, which has cones to lose.
  std::vector<double> smoothest_diffusion_times{16.0, 4.0, 1.0, 1.0};
  /// #F or empty: directions that a frame's axes should take, as vectors in the faces' planes; the length is the strength,
  /// 0 (free) to 1 (followed wherever features let it).
  std::vector<Vector3> guides;
  /// 0..1: how much the surface's curvature guides the field where it bends one way more than the other.
  double curvature_alignment = 0;
  /// 0..1: how far frames turn, and cones arise, so that quads of varying target lengths fit together.
  double turn_for_lengths = 0;
};

/// The smoothest 4-symmetric field aligned to features and boundaries, as orthonormal frames (|du| = |dv| = 1): z = e^{4 i
/// theta} on faces with a connection of averaged curvature (docs/decisions/0030). Solved twice, by multilevel relaxation and
/// from the smoothest field without |z| = 1, both finished by diffusion; the one with less energy and fewer cones is kept (docs/decisions/0011).
/// \post sum of cone indices and of the features' turning agrees with the Euler characteristic (Poincare-Hopf)
FrameField solve_frame_field(const WorkingSurface& surface, const FrameFieldOptions& options, const RunContext& context);

/// Matchings, combing and cone indices of given frames (rows du, dv per face).
/// \param angles  of the surface, with the turns that matchings are nearest to
FrameField frame_field_from_rows(const WorkingSurface& surface, const FaceAngles& angles, std::vector<Vector3> du,
                                 std::vector<Vector3> dv, const RunContext& context = {});

/// Irregular vertices inside the surface that the field has because of features: vertices on them where, sector by sector
/// and at least one in each, other than four quads meet; and one beside every acute tip, a sector in which frames leave no
/// room for the quad that has to be there, because three quads meet where that quad ends.
int count_feature_cones(const WorkingSurface& surface, const std::vector<Vector3>& du, const std::vector<Vector3>& dv,
                        const RunContext& context = {});

std::vector<std::string> violations_of(const FrameField& field, const WorkingSurface& surface);

}  // namespace hybrid_quad
