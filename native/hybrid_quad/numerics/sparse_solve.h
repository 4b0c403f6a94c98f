#pragma once

#include <Eigen/Core>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/base/types.h"
#include "hybrid_quad/numerics/sparse_factor.h"
#include "hybrid_quad/numerics/sparse_matrix.h"

namespace hybrid_quad {

/// Solves A x = b for a symmetric positive definite A, given by its lower triangle, whose unknowns lie on a surface, by a
/// sparse factorization. On surface meshes that is faster than preconditioned conjugate gradients (incomplete Cholesky,
/// plain and smoothed aggregation multigrid) up to a million unknowns.
/// \param places  where the unknowns are (scene units): couplings should be short; empty: not known, for few unknowns
///
/// Robust: a matrix that is singular to working precision is shifted until it can be factorized (a direction that A does
/// not see then stays small), and the residual is improved against the unshifted matrix. Unknowns without any entry
/// come out as 0; a right side that is not finite gives 0.
Eigen::VectorXd solve_sparse(const SparseMatrix& lower, const Eigen::VectorXd& right_side,
                             const std::vector<Vector3>& places, const RunContext& context);

/// The same where several matrices have the same pattern, for which `factor` was made: an order of elimination is found once.
Eigen::VectorXd solve_sparse(const SparseMatrix& lower, const Eigen::VectorXd& right_side, SparseFactor& factor,
                             const RunContext& context);

}  // namespace hybrid_quad
