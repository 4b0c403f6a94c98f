#include "hybrid_quad/numerics/sparse_factor.h"

#include "hybrid_quad/base/interruptible.h"

namespace hybrid_quad {

SparseFactor::SparseFactor(const SparseMatrix& lower, const std::vector<Vector3>& places, const RunContext& context) {
  constexpr Eigen::Index kMostByColumns = 4000;
  if (!places.empty() && lower.rows() > kMostByColumns) {
    by_fronts_ = std::make_unique<MultifrontalCholesky>(lower, places, context);
    return;
  }
  by_columns_ = std::make_shared<ByColumns>();
  const auto pattern = std::make_shared<const SparseMatrix>(lower);
  run_interruptibly(context, 0.1, [factor = by_columns_, pattern] { factor->analyzePattern(*pattern); });
}

bool SparseFactor::factorize(const SparseMatrix& lower, double shift, const RunContext& context) {
  if (by_fronts_) return by_fronts_->factorize(lower, shift, context);
  by_columns_->setShift(shift);
  const auto matrix = std::make_shared<const SparseMatrix>(lower);
  run_interruptibly(context, 0.3, [factor = by_columns_, matrix] { factor->factorize(*matrix); });
  return by_columns_->info() == Eigen::Success && by_columns_->vectorD().minCoeff() > 0;
}

Eigen::VectorXd SparseFactor::solve(const Eigen::VectorXd& right_side, int threads) const {
  if (by_fronts_) return by_fronts_->solve(right_side, threads);
  return by_columns_->solve(right_side);
}

}  // namespace hybrid_quad
