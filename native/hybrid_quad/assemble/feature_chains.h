#pragma once

#include "hybrid_quad/features/features.h"
#include "hybrid_quad/mesh/quad_mesh.h"

namespace hybrid_quad {

/// Lists the feature edges curve by curve, in the order and direction of the curves of the input.
void order_feature_edges(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features);

}  // namespace hybrid_quad
