#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/working_surface/working_surface.h"

namespace hybrid_quad {

/// How a surface bends around a face: principal curvatures by size, |strong| >= |weak|, positive where it is convex.
struct PrincipalCurvature {
  Vector3 direction = Vector3::Zero();  ///< unit, in the face's plane, in which it bends by `strong`; zero where flat
  double strong = 0, weak = 0;          ///< 1 / scene units

  /// How much more it bends one way than the other, over a quad of edge length h: 0 for a ball or a plane.
  double anisotropy(double h) const { return std::abs(strong - weak) * h; }
};

/// Curvature averaged over about 1.5 quad edges, whatever the input's triangles: bends smaller than a quad cancel.
/// Edge tensors (Cohen-Steiner and Morvan 2003) of the working surface, whose edges are a fixed part of a quad's,
/// averaged over neighbouring faces but not across features, which bend sharply and say nothing of the faces beside.
/// \return #F
std::vector<PrincipalCurvature> principal_curvatures(const WorkingSurface& surface, const RunContext& context = {});

}  // namespace hybrid_quad
