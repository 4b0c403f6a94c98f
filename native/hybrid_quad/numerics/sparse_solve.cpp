#include "hybrid_quad/numerics/sparse_solve.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

namespace {

double largest_diagonal(const SparseMatrix& lower) {
  double largest = 0;
  for (int c = 0; c < lower.outerSize(); ++c)
    for (SparseMatrix::InnerIterator it(lower, c); it; ++it)
      if (it.row() == it.col()) largest = std::max(largest, std::abs(it.value()));
  return largest;
}

/// Factorizes A + shift I with the smallest shift of a few that leaves only positive pivots. \return success
bool factorize(const SparseMatrix& lower, SparseFactor& factor, const RunContext& context) {
  const double largest = largest_diagonal(lower);
  for (const double shift : {0.0, 1e-14, 1e-11, 1e-8})
    if (factor.factorize(lower, shift * largest, context)) return true;
  return false;
}

bool is_worth_solving(const Eigen::VectorXd& right_side) {
  const double size = right_side.norm();
  return size > 0 && std::isfinite(size);
}

}  // namespace

Eigen::VectorXd solve_sparse(const SparseMatrix& lower, const Eigen::VectorXd& right_side,
                             const std::vector<Vector3>& places, const RunContext& context) {
  if (!is_worth_solving(right_side)) return Eigen::VectorXd::Zero(right_side.size());
  SparseFactor factor(lower, places, context);
  return solve_sparse(lower, right_side, factor, context);
}

Eigen::VectorXd solve_sparse(const SparseMatrix& lower, const Eigen::VectorXd& right_side, SparseFactor& factor,
                             const RunContext& context) {
  constexpr int kRefinements = 3;
  constexpr double kTolerance = 1e-10;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(right_side.size());
  if (!is_worth_solving(right_side)) return x;
  const double size = right_side.norm();
  if (!factorize(lower, factor, context)) return x;
  Eigen::VectorXd residual = right_side;
  double left = size;
  for (int step = 0; step < kRefinements && left > kTolerance * size; ++step) {
    const Eigen::VectorXd improved = x + factor.solve(residual, context.threads);
    const Eigen::VectorXd rest = right_side - lower.selfadjointView<Eigen::Lower>() * improved;
    if (!(rest.norm() < left)) break;
    x = improved;
    residual = rest;
    left = rest.norm();
  }
  return x;
}

}  // namespace hybrid_quad
