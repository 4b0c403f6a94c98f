#pragma once

#include <vector>

#include "hybrid_quad/features/features.h"

namespace hybrid_quad {

/// The input's feature graph on a mesh made from the input by local operations: the same curves (ids, direction), corners
/// and regions.
/// \param halfedge_curve, face_region  as the operations handed them on
/// \param input_vertex  #V: input vertex or -1; along a loop at least three of its own are left
FeatureGraph transferred_features(const TriangleMesh& mesh, std::vector<int> halfedge_curve, std::vector<int> face_region,
                                  const std::vector<int>& input_vertex, const FeatureGraph& input_features);

}  // namespace hybrid_quad
