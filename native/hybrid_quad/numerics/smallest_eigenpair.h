#pragma once

#include <Eigen/SparseCore>

namespace hybrid_quad {

/// The smallest eigenvalue of a symmetric matrix with its unit eigenvector.
struct Eigenpair {
  double value = 0;
  Eigen::VectorXd vector;  ///< unit length
  double residual = 0;     ///< |A x - value x| / (largest absolute entry of the diagonal)
  bool converged = false;  ///< the solver's own tolerance was met; else the best vector found
};

struct EigenOptions {
  double tolerance = 1e-6;  ///< relative, of the inverted spectrum
  int max_restarts = 100;
  int basis = 12;  ///< Lanczos vectors kept
};

/// Shift-invert Lanczos (Spectra, Qiu 2015) about a point just below zero.
/// \param lower  positive semidefinite; only the lower triangle is read
/// \throws InternalError if the matrix is empty or cannot be factored
Eigenpair smallest_eigenpair(const Eigen::SparseMatrix<double>& lower, const EigenOptions& options);

}  // namespace hybrid_quad
