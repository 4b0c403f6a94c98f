#pragma once

#include <vector>

#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// Local projection onto a triangle mesh: from face `start` downhill to the nearest point of p that can be reached
/// without entering another region. Crosses an edge only where the nearest point of the face lies on it, so that it
/// looks at a face or two a step. Where thousands of needles lie on its way it ends before: nearer than the start, not nearest.
/// \pre start is a face
SurfacePoint walk_to_nearest(const TriangleMesh& mesh, const std::vector<int>& region, const Vector3& p, int start);

}  // namespace hybrid_quad
