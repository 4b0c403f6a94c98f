#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/frame_field/frame_field.h"

namespace hybrid_quad {

/// Up to this lambda frames count as integrable all over: a relative curl of half a hundredth would cost as much as a frame that is
/// off by its own size (docs/decisions/0036).
constexpr double kMostForPotentials = 2e-5;

struct CurlCorrectionOptions {
  double curl_weight = 1e-5;     ///< lambda
  double feature_weight = 30.0;
  /// #F or empty: how firmly a frame keeps its directions, 1 = as any; its lengths stay as free as they were.
  std::vector<double> direction_weight;
  int max_raises = 1;              ///< solves with more lambda around folded faces, while they are more than
  double tolerated_folds = 1e-3;   ///< this share of all faces
};

/// \return true if x keeps a frame a frame: not folded (det > 0.2), not stretched beyond use
bool is_sound_correction(const std::array<double, 4>& x);

/// How to change every frame, (du, dv) -> X (du, dv) with X = {X00, X01, X10, X11}, so that the edge of two faces
/// measures the same in both: the minimum over X of
///   sum over edges  w |X_f d_f + turn (X_g d_g)|^2  +  lambda sum over faces  area (|X - I|^2 weighted 1 on the diagonal, 2 off it, or
/// more where directions are to stay)
/// and of the transversal part of feature edges. By VertexPotentials for small lambda, by EdgeMultipliers otherwise.
/// \return #F matrices; the identity where nothing couples
std::vector<std::array<double, 4>> curl_correction(const WorkingSurface& surface, const FrameField& field,
                                                   const CurlCorrectionOptions& options, const RunContext& context);

/// Root mean square of what an edge measures differently in its two faces, relative to its length in quads.
double curl_of(const TriangleMesh& mesh, const FrameField& field);

}  // namespace hybrid_quad
