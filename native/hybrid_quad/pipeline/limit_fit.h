#pragma once

#include "hybrid_quad/pipeline/component.h"
#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {

/// Fits the limit surface of a component's quads, with their mirror images, to the whole surface (fit_limit_surface).
/// Vertices on a mirror plane stay on it.
/// \param quads  the component's with their mirror images; its own vertices are the first, and those that move
/// \param mesh  of the plan: the features are on it
LimitFitReport fit_component(ComponentResult& component, const QuadMesh& quads, const TriangleMesh& mesh, PlaneSet planes,
                             const SurfaceIndex& whole, const RunContext& context);

/// Adds a component's report. \param share  of the surface's area \param diagonal  of the whole surface
void add_fit(LimitFitRecord& record, const LimitFitReport& report, double share, double diagonal);

}  // namespace hybrid_quad
