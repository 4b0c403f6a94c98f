#pragma once

#include <vector>

#include "hybrid_quad/features/features.h"

namespace hybrid_quad {

struct ChordOptions {
  double error = 0;    ///< largest distance between the surface and a quad or its edges (scene units)
  double start = 0;    ///< length at which curvature is looked at first (scene units)
  double least = 0, longest = 0;  ///< bounds of the lengths (scene units)
};

/// Edge lengths for which quads with their corners on the surface stay within a distance of it: sqrt(8 error / bend), where
/// the bend is the larger of |k1|, over an edge, and |k1 + k2|, over the middle of a quad along the principal directions.
/// Curvature is averaged over the quads that it asks for: in rounds, finer to coarser or the other way.
/// \return #V of `mesh`, within the bounds and graded
std::vector<double> chord_lengths(const TriangleMesh& mesh, const FeatureGraph& features, const ChordOptions& options,
                                  const RunContext& context);

}  // namespace hybrid_quad
