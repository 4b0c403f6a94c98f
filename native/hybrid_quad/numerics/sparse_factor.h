#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/numerics/multifrontal_cholesky.h"

namespace hybrid_quad {

/// A factorization of a symmetric positive definite matrix whose unknowns lie on a surface. Up to four thousand
/// unknowns by columns in minimum-degree order, which fills in least; beyond that multifrontal, which gets several
/// times as fast with size.
class SparseFactor {
 public:
  /// \param places  where the unknowns are (scene units): couplings should be short; empty: not known, by columns
  SparseFactor(const SparseMatrix& lower, const std::vector<Vector3>& places, const RunContext& context);

  /// Factorizes A + shift I. \param lower with the pattern that the constructor saw
  /// \return false if a pivot is not positive
  bool factorize(const SparseMatrix& lower, double shift, const RunContext& context);
  /// \pre factorize() succeeded
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side, int threads) const;

 private:
  using ByColumns = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>;
  std::shared_ptr<ByColumns> by_columns_;  ///< shared with a factorization that may outlive a cancelled run
  std::unique_ptr<MultifrontalCholesky> by_fronts_;
};

}  // namespace hybrid_quad
