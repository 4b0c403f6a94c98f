#include "hybrid_quad/numerics/sparse_solve.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <memory>

#include "hybrid_quad/base/interruptible.h"

namespace hybrid_quad {

namespace {

using Factor = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>;

double largest_diagonal(const SparseMatrix& lower) {
  double largest = 0;
  for (int c = 0; c < lower.outerSize(); ++c)
    for (SparseMatrix::InnerIterator it(lower, c); it; ++it)
      if (it.row() == it.col()) largest = std::max(largest, std::abs(it.value()));
  return largest;
}

/// Factorizes A + shift I with the smallest shift of a few that leaves only positive pivots. \return success
bool factorize(const std::shared_ptr<const SparseMatrix>& lower, const std::shared_ptr<Factor>& factor, const RunContext& context) {
  const double largest = largest_diagonal(*lower);
  run_interruptibly(context, 0.1, [=] { factor->analyzePattern(*lower); });
  for (const double shift : {0.0, 1e-14, 1e-11, 1e-8}) {
    factor->setShift(shift * largest);
    run_interruptibly(context, 0.3, [=] { factor->factorize(*lower); });
    if (factor->info() == Eigen::Success && factor->vectorD().minCoeff() > 0) return true;
  }
  return false;
}

}  // namespace

Eigen::VectorXd solve_sparse(const SparseMatrix& lower, const Eigen::VectorXd& right_side, const RunContext& context) {
  constexpr int kRefinements = 3;
  constexpr double kTolerance = 1e-10;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(right_side.size());
  const double size = right_side.norm();
  if (!(size > 0) || !std::isfinite(size)) return x;
  const auto factor = std::make_shared<Factor>();
  if (!factorize(std::make_shared<const SparseMatrix>(lower), factor, context)) return x;
  Eigen::VectorXd residual = right_side;
  double left = size;
  for (int step = 0; step < kRefinements && left > kTolerance * size; ++step) {
    const Eigen::VectorXd improved = x + factor->solve(residual);
    const Eigen::VectorXd rest = right_side - lower.selfadjointView<Eigen::Lower>() * improved;
    if (!(rest.norm() < left)) break;
    x = improved;
    residual = rest;
    left = rest.norm();
  }
  return x;
}

}  // namespace hybrid_quad
