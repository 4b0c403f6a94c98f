#pragma once

#include <Eigen/SparseCore>

#include "hybrid_quad/base/run_context.h"

namespace hybrid_quad {

using SparseMatrix = Eigen::SparseMatrix<double>;

struct SparseSolveOptions {
  double tolerance = 1e-6;   ///< of the residual, relative to the right side
  int max_iterations = 200;  ///< of the iterative solver, before the direct one takes over
};

/// Solves A x = b for a symmetric positive definite A, given by its lower triangle.
///
/// Conjugate gradients with an aggregation multigrid (near-linear time for what behaves like a Laplacian, whatever the
/// signs of its couplings); a sparse factorization where they do not converge. A direction in which A is singular to
/// working precision is left at zero.
Eigen::VectorXd solve_sparse(const SparseMatrix& lower, const Eigen::VectorXd& right_side, const SparseSolveOptions& options,
                             const RunContext& context);

/// The same by a sparse factorization only.
Eigen::VectorXd solve_sparse_directly(const SparseMatrix& lower, const Eigen::VectorXd& right_side);

}  // namespace hybrid_quad
