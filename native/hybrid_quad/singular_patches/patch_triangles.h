#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/grid_algebra/quarter_turn.h"
#include "hybrid_quad/regular_quads/regular_quads.h"
#include "hybrid_quad/singular_patches/patch_quads.h"

namespace hybrid_quad {

/// A patch while it is cut and refined: triangles with their own gluing, phases at corners (each triangle in the gauge of
/// its face) and the phase steps along half-edges.
struct PatchTriangles {
  std::vector<Vector3> positions;
  std::vector<int> node;                        ///< #V: overlay vertex of a border extremum, or -1
  std::vector<std::int8_t> grid_sign;           ///< #V: sign of an inner grid point, 0 elsewhere
  std::vector<std::array<int, 3>> faces;
  std::vector<int> opposite;                    ///< 3 #F
  std::vector<PhasePair> phase;                 ///< 3 #F: at the corner
  std::vector<std::array<double, 2>> step;      ///< 3 #F: increments of (alpha, beta) along the half-edge
  std::vector<int> arc;                         ///< 3 #F: first overlay half-edge of the arc a border half-edge is part of, or -1
  std::vector<std::array<double, 2>> arc_span;  ///< 3 #F: where on the arc, from 0 to 1, the border half-edge begins and ends
};

/// The steps of the two phases (radians) from p to q that are nearest to what is wanted.
std::array<double, 2> lifted_step(const PhasePair& p, const PhasePair& q, const std::array<double, 2>& wanted);

/// The pieces of one patch as triangles. \param pieces overlay pieces of the patch, ascending
PatchTriangles triangulate_patch(const GridOverlay& overlay, const SpanningParameterization& param,
                                 const WorkingSurface& surface, const FrameField& frames,
                                 const std::vector<int>& pieces);

/// Splits edges until none is longer than `longest` quads and no inner edge joins two border vertices. Midpoints take
/// half the phase step of their edge, so the parameterization is reproduced exactly where it exists.
/// \param target_length quad edge in scene units
void refine_patch(PatchTriangles& patch, double longest, double target_length, const RunContext& context);

/// The Morse function at the vertices: Psi0 inside, cosine along the arcs, -+1.01 at nodes.
PatchSurface finish_patch(const PatchTriangles& patch, const GridOverlay& overlay, double target_length);

}  // namespace hybrid_quad
