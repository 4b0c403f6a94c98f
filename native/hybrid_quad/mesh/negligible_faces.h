#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

enum class Weight : char { kCounts, kNoArea, kTiny };

/// Whether the component that each face is part of has any area, and not less than `least_share` of the whole surface's.
std::vector<Weight> weight_of_faces(const TriangleMesh& mesh, double least_share);

}  // namespace hybrid_quad
