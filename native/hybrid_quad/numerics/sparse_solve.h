#pragma once

#include <Eigen/SparseCore>

#include "hybrid_quad/base/run_context.h"

namespace hybrid_quad {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Solves A x = b for a symmetric positive definite A, given by its lower triangle, by a sparse LDL^T factorization in
/// minimum-degree order. On surface meshes that is near-linear in practice, and faster than preconditioned conjugate
/// gradients (incomplete Cholesky, aggregation multigrid) up to several hundred thousand unknowns.
///
/// Robust: a matrix that is singular to working precision is shifted until it can be factorized (a direction that A does
/// not see then stays small), and the residual is improved against the unshifted matrix. Unknowns without any entry
/// come out as 0; a right side that is not finite gives 0.
Eigen::VectorXd solve_sparse(const SparseMatrix& lower, const Eigen::VectorXd& right_side, const RunContext& context);

}  // namespace hybrid_quad
