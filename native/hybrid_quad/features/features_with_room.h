#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/features/features.h"

namespace hybrid_quad {

/// Which features remain where they may not be nearer to each other than a gap. Curves that go on straight through their
/// ends count as one line; the longest and sharpest lines are taken first, and one that runs mostly within a gap of what was
/// taken goes, as do lines and pieces that are hardly longer than it.
/// \param is_kept  3 #F: half-edges of features that stay whatever else there is, both sides of an edge alike
/// \param gap  scene units
/// \returns 3 #F: half-edges of features that remain  \throws Cancelled
std::vector<char> features_with_room(const TriangleMesh& mesh, const FeatureGraph& features, const std::vector<char>& is_kept,
                                     double gap, const RunContext& context);

}  // namespace hybrid_quad
