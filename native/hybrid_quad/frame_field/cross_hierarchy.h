#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/frame_field/cross_system.h"

namespace hybrid_quad {

/// A level of the hierarchy: the system, its rows, and how its nodes hang on the next coarser level.
struct CrossLevel {
  CrossSystem system;
  std::vector<int> row_begin, neighbour;
  std::vector<Complex> weight;        ///< row i wants z_i along sum of weight * z_neighbour
  std::vector<int> aggregate;         ///< node of the coarser level; empty on the coarsest
  std::vector<Complex> prolongation;  ///< z_i = prolongation_i * z_aggregate
};

/// Levels from the system itself to one of about `coarsest` nodes. Nodes are aggregated in pairs, in the gauge of the
/// pair's first node, so a coarse node stands for a parallel field over its aggregate (Galerkin). Near-linear time.
std::vector<CrossLevel> cross_hierarchy(const CrossSystem& system, int coarsest, const RunContext& context);

/// Values of the coarser level carried to `fine`.
std::vector<Complex> prolonged(const CrossLevel& fine, const std::vector<Complex>& coarse);

}  // namespace hybrid_quad
