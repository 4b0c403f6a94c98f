#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Half-edges of ways from loose ends of features to others close by: slivers along a crease interrupt it (docs/decisions/0055). A way is the
/// shortest one over other edges; an end that is as near to all there is along features has none.
/// \param is_feature  3 #F, symmetric  \param reach  scene units: the longest way
std::vector<int> ways_over_gaps(const TriangleMesh& mesh, const std::vector<char>& is_feature, double reach, const RunContext& context);

}  // namespace hybrid_quad
