#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

enum class Weight : char { kCounts, kNoArea, kTiny, kThin };

/// What the component that each face is part of has too little of for quads: any area, `least_share` of the whole surface's, or
/// `least_width`: its area over the square of its box's diagonal.
std::vector<Weight> weight_of_faces(const TriangleMesh& mesh, double least_share, double least_width);

}  // namespace hybrid_quad
