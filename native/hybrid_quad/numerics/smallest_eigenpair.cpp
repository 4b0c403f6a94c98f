#include "hybrid_quad/numerics/smallest_eigenpair.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <Spectra/SymEigsShiftSolver.h>
#include <algorithm>
#include <cmath>

#include "hybrid_quad/base/errors.h"

namespace hybrid_quad {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// x -> (A - sigma I)^{-1} x in the form that Spectra asks for.
class InverseOperator {
 public:
  using Scalar = double;
  explicit InverseOperator(const Sparse& lower) : lower_(lower) {}
  Eigen::Index rows() const { return lower_.rows(); }
  Eigen::Index cols() const { return lower_.cols(); }
  void set_shift(double sigma) {
    Sparse shifted = lower_;
    for (Eigen::Index i = 0; i < shifted.rows(); ++i) shifted.coeffRef(i, i) -= sigma;
    factor_.compute(shifted);
    if (factor_.info() != Eigen::Success)
      throw InternalError("eigenpair", "the shifted matrix cannot be factored");
  }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, rows()) = factor_.solve(Eigen::Map<const Eigen::VectorXd>(x, rows()));
  }

 private:
  const Sparse& lower_;
  Eigen::SimplicialLDLT<Sparse> factor_;
};

double largest_diagonal(const Sparse& lower) {
  double largest = 0;
  for (Eigen::Index i = 0; i < lower.rows(); ++i) largest = std::max(largest, std::abs(lower.coeff(i, i)));
  return largest;
}

Eigenpair smallest_of_dense(const Sparse& lower) {
  const Eigen::MatrixXd full = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(full);
  Eigenpair pair;
  pair.value = solver.eigenvalues()[0];
  pair.vector = solver.eigenvectors().col(0);
  pair.converged = solver.info() == Eigen::Success;
  return pair;
}

Eigenpair smallest_by_lanczos(const Sparse& lower, double scale, const EigenOptions& options) {
  const int n = static_cast<int>(lower.rows());
  InverseOperator inverse(lower);
  const double shift = -1e-7 * scale;
  Spectra::SymEigsShiftSolver<InverseOperator> solver(inverse, 1, std::clamp(options.basis, 3, n), shift);
  solver.init();
  const auto found = solver.compute(Spectra::SortRule::LargestMagn, options.max_restarts, options.tolerance);
  Eigenpair pair;
  pair.converged = found == 1 && solver.info() == Spectra::CompInfo::Successful;
  if (pair.converged) {
    pair.vector = solver.eigenvectors(1).col(0).normalized();
  } else {
    // A few inverse iterations from a fixed start: not the eigenvector, but a smooth vector of low energy.
    pair.vector.resize(n);
    for (int i = 0; i < n; ++i) pair.vector[i] = 1 + 0.5 * std::sin(1.0 + i);
    Eigen::VectorXd next(n);
    for (int step = 0; step < 5; ++step) {
      inverse.perform_op(pair.vector.data(), next.data());
      pair.vector = next.normalized();
    }
  }
  const Eigen::VectorXd applied = lower.selfadjointView<Eigen::Lower>() * pair.vector;
  pair.value = pair.vector.dot(applied);
  return pair;
}

}  // namespace

Eigenpair smallest_eigenpair(const Sparse& lower, const EigenOptions& options) {
  if (lower.rows() == 0 || lower.rows() != lower.cols())
    throw InternalError("eigenpair", "the matrix is empty or not square");
  const double scale = largest_diagonal(lower);
  Eigenpair pair = lower.rows() <= 8 || !(scale > 0) ? smallest_of_dense(lower)
                                                     : smallest_by_lanczos(lower, scale, options);
  const Eigen::VectorXd applied = lower.selfadjointView<Eigen::Lower>() * pair.vector;
  const Eigen::VectorXd misfit = applied - pair.value * pair.vector;
  pair.residual = scale > 0 ? misfit.norm() / scale : misfit.norm();
  return pair;
}

}  // namespace hybrid_quad
