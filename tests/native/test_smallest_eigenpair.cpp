#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/numerics/smallest_eigenpair.h"

namespace hybrid_quad {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// The second difference on a chain with fixed ends; its smallest eigenvalue is 2 - 2 cos(pi / (n + 1)).
Sparse chain(int n, double scale = 1) {
  Sparse a(n, n);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2 * scale);
    if (i) entries.emplace_back(i, i - 1, -scale);
  }
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

TEST(SmallestEigenpair, FindsTheChainsFundamental) {
  for (const int n : {2, 9, 50, 400})
    for (const double scale : {1e-8, 1.0, 1e8}) {
      const Eigenpair pair = smallest_eigenpair(chain(n, scale), EigenOptions{});
      EXPECT_TRUE(pair.converged);
      EXPECT_NEAR(pair.value / scale, 2 - 2 * std::cos(M_PI / (n + 1)), 1e-9);
      EXPECT_NEAR(pair.vector.norm(), 1, 1e-12);
      EXPECT_LT(pair.residual, 1e-6);
    }
}

TEST(SmallestEigenpair, AgreesWithADenseSolver) {
  const int n = 40;
  Eigen::MatrixXd b(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) b(i, j) = (std::abs(i - j) < 4) ? std::sin(1.0 + i * 7 + j * j) : 0;
  const Eigen::MatrixXd dense = b * b.transpose();
  const Sparse lower = Eigen::MatrixXd(dense.triangularView<Eigen::Lower>()).sparseView();
  const Eigenpair pair = smallest_eigenpair(lower, EigenOptions{});
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> exact(dense);
  EXPECT_NEAR(pair.value, exact.eigenvalues()[0], 1e-8 * dense.norm());
}

TEST(SmallestEigenpair, TakesASingularMatrix) {
  Sparse a = chain(60);
  a.coeffRef(0, 0) = a.coeffRef(59, 59) = 1;  // free ends: constants are in the kernel
  const Eigenpair pair = smallest_eigenpair(a, EigenOptions{});
  EXPECT_NEAR(pair.value, 0, 1e-9);
  EXPECT_NEAR(pair.vector.maxCoeff(), pair.vector.minCoeff(), 1e-6);
}

TEST(SmallestEigenpair, RefusesNothing) {
  EXPECT_THROW(smallest_eigenpair(Sparse(0, 0), EigenOptions{}), InternalError);
}

}  // namespace
}  // namespace hybrid_quad
