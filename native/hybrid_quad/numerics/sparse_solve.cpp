#include "hybrid_quad/numerics/sparse_solve.h"

#include <Eigen/SparseCholesky>
#include <cmath>

#include "hybrid_quad/numerics/aggregation_multigrid.h"

namespace hybrid_quad {

namespace {

/// Flexible conjugate gradients. \return true if the residual fell below the tolerance
bool iterate(const SparseMatrix& lower, const Eigen::VectorXd& b, const SparseSolveOptions& options, const RunContext& context,
             Eigen::VectorXd& x) {
  AggregationMultigrid multigrid(lower);
  x = Eigen::VectorXd::Zero(b.size());
  const double goal = options.tolerance * b.norm();
  Eigen::VectorXd residual = b, correction, direction, image;
  double previous_curvature = 0;
  for (int step = 0; step < options.max_iterations; ++step) {
    if (step % 4 == 0) context.checkpoint(0.5);
    multigrid.precondition(residual, correction);
    // Against the last direction explicitly: the preconditioner changes from step to step.
    if (step > 0) correction -= (correction.dot(image) / previous_curvature) * direction;
    direction = correction;
    multigrid.multiply(direction, image);
    const double curvature = direction.dot(image);
    if (!(curvature > 0) || !std::isfinite(curvature)) return false;
    const double length = direction.dot(residual) / curvature;
    x += length * direction;
    residual -= length * image;
    previous_curvature = curvature;
    const double size = residual.norm();
    if (!std::isfinite(size)) return false;
    if (size <= goal) return true;
  }
  return false;
}

}  // namespace

Eigen::VectorXd solve_sparse_directly(const SparseMatrix& lower, const Eigen::VectorXd& right_side) {
  SparseMatrix matrix = lower;
  double largest = 0;
  for (int i = 0; i < matrix.rows(); ++i) largest = std::max(largest, std::abs(matrix.coeff(i, i)));
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower> factor;
  factor.analyzePattern(matrix);
  for (double shift = 0; shift < 1; shift = shift > 0 ? 100 * shift : 1e-14) {
    factor.setShift(shift * largest);
    factor.factorize(matrix);
    if (factor.info() != Eigen::Success) continue;
    const Eigen::VectorXd x = factor.solve(right_side);
    if (x.allFinite()) return x;
  }
  return Eigen::VectorXd::Zero(right_side.size());
}

Eigen::VectorXd solve_sparse(const SparseMatrix& lower, const Eigen::VectorXd& right_side, const SparseSolveOptions& options,
                             const RunContext& context) {
  const double size = right_side.norm();
  if (right_side.size() == 0 || !(size > 0) || !std::isfinite(size)) return Eigen::VectorXd::Zero(right_side.size());
  Eigen::VectorXd x;
  if (iterate(lower, right_side, options, context, x)) return x;
  context.checkpoint(0.5);
  return solve_sparse_directly(lower, right_side);
}

}  // namespace hybrid_quad
