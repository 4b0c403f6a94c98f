#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

constexpr double kLeastWidth = 2e-6;  ///< of a component: its area over the square of its box's diagonal (docs/decisions/0050)
constexpr double kLeastShare = 1e-9;  ///< of the area; components with less are specks, a thirty thousandth as long as the rest

enum class Weight : char { kCounts, kNoArea, kTiny, kThin };

/// What the component that each face is part of has too little of for quads: any area, kLeastShare of the whole surface's, or kLeastWidth.
std::vector<Weight> weight_of_faces(const TriangleMesh& mesh);

/// Some faces of a mesh, in their order, and what they and their vertices are there.
struct CountingFaces {
  TriangleMesh mesh;
  std::vector<int> vertex, face;
};

/// The components of a mesh whose faces have these weights and count.
CountingFaces faces_that_count(const TriangleMesh& mesh, const std::vector<Weight>& weight);

}  // namespace hybrid_quad
