#include "hybrid_quad/frame_field/averaging_steps.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

int averaging_steps(const WorkingSurface& surface, double spread, double step) {
  constexpr double kMostSteps = 200;
  double square = 0;  // of a triangle's edge, in quad edges
  for (int h = 0; h < surface.mesh.halfedge_count(); ++h) {
    const double edge = surface.mesh.edge_length(h) / surface.target_length[h / 3];
    square += edge * edge;
  }
  square /= std::max(1, surface.mesh.halfedge_count());
  const double steps = spread * spread / (step * step * square);
  return static_cast<int>(steps < kMostSteps ? std::ceil(steps) : kMostSteps);
}

}  // namespace hybrid_quad
