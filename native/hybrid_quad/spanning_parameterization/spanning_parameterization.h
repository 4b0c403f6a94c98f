#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hybrid_quad/periodic_field/periodic_field.h"

namespace hybrid_quad {

/// A parameterization of every face in its own chart, exact in fixed point (kGridUnit = one quad edge).
///
/// Exactness: for an interior half-edge h of face f with opposite o of face g, halfedge_uv[o] =
/// -turned(halfedge_uv[h], matching[h]) to the last bit. A face without charge closes: its three halfedge_uv
/// sum to zero and corner_uv[i+1] = corner_uv[i] + halfedge_uv. At every corner corner_uv equals the vertex's
/// value turned into the face, up to a translation of the lattice D2 = {(T1, T2): T1 + T2 even} (in units of
/// kGridUnit). A feature edge of a regular face has one zero component.
struct SpanningParameterization {
  std::vector<GridVector> corner_uv;    ///< 3 #F
  std::vector<GridVector> halfedge_uv;  ///< 3 #F: from corner i to corner i + 1
  std::vector<std::array<int, 2>>
      charge;                        ///< #F: windings of (a, b) around the face; (0, 0) = no dislocation
  std::vector<char> is_regular;      ///< #F: no charge, det > 0, feature edges on isolines
  std::vector<char> is_grid_vertex;  ///< #V: cones (odd index) and corners, pinned to integer points

  int dislocations_found = 0;    ///< unit charges before cancellation
  int dislocations_left = 0;     ///< after
  int folded_faces = 0;          ///< faces with det <= 0
  int folded_feature_edges = 0;  ///< feature edges along which the coordinate does not grow
  int vanished_curves = 0;       ///< feature curves that get no quad edge
};

struct SpanningOptions {
  bool cancel_dislocations = true;
  int strip_rows = 1;         ///< as in PeriodicFieldOptions
  double cone_cost = 0.3;     ///< cost of absorbing a charge at a cone, in quads
  int stiffening_rounds = 3;  ///< re-solves with more weight around folded faces
};

/// Lifts Psi to differences along edges (one rounding per edge, from the average of both sides), moves
/// integers so that dislocations cancel (docs/decisions/0004), and solves the Poisson problem that
/// spreads the slip. (Paper 4.2; the tree-free form: every edge is lifted alone, so seams cannot mismatch and
/// all defects are charges of faces.)
SpanningParameterization build_spanning_parameterization(const WorkingSurface& surface,
                                                         const FrameField& frames, const PeriodicField& psi,
                                                         const SpanningOptions& options,
                                                         const RunContext& context);

/// What of the promises above does not hold, and that features of regular faces lie on integer lines, cones and corners at integer points.
/// Compares integers for equality.
std::vector<std::string> violations_of(const SpanningParameterization& param, const WorkingSurface& surface,
                                       const FrameField& frames);

}  // namespace hybrid_quad
