#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/periodic_field/phase_graph.h"

namespace hybrid_quad {

/// Minimises the energy over unit phases from coarse to fine: pairwise aggregation down to `options.coarsest`
/// nodes, the smallest eigenvector there, relaxation on the way up.
std::vector<PhasePair> solve_multilevel_phases(PhaseGraph finest, const PeriodicFieldOptions& options,
                                               const RunContext& context);

}  // namespace hybrid_quad
