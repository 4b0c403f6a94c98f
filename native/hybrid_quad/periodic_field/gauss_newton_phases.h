#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/periodic_field/phase_graph.h"

namespace hybrid_quad {

/// The paper's own way at full size (3.3): the smallest eigenvector of the quadratic form, then Gauss-Newton
/// on E / W_sum + w_r mean(((|a|^2 - 1)^2 + (|b|^2 - 1)^2) / 2), Eq. (18) with the second constraint weighted
/// 4. Slower than the multilevel solve and higher in energy: a reference.
std::vector<PhasePair> solve_gauss_newton_phases(const PhaseGraph& graph, const PeriodicFieldOptions& options,
                                                 const RunContext& context);

}  // namespace hybrid_quad
