#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "hybrid_quad/numerics/multifrontal_cholesky.h"
#include "hybrid_quad/numerics/sparse_solve.h"

namespace hybrid_quad {
namespace {

struct Problem {
  SparseMatrix lower;
  std::vector<Vector3> places;
};

/// Couplings of either sign between the neighbours of a grid of `side` x `side` unknowns, `sheets` times, and a little of
/// each unknown's own.
Problem grid_problem(int side, int sheets, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> weight(0.2, 2);
  const int n = sheets * side * side;
  std::vector<Eigen::Triplet<double>> entries;
  Problem problem;
  const auto couple = [&](int i, int j) {
    const double w = weight(random);
    entries.emplace_back(i, i, w);
    entries.emplace_back(j, j, w);
    entries.emplace_back(std::max(i, j), std::min(i, j), random() % 2 == 0 ? w : -w);
  };
  for (int i = 0; i < n; ++i) {
    const int x = i % side, y = i / side % side;
    problem.places.emplace_back(x, y, 0.1 * x * y / side);
    entries.emplace_back(i, i, 1e-3);
    if (x > 0) couple(i, i - 1);
    if (y > 0) couple(i, i - side);
  }
  problem.lower.resize(n, n);
  problem.lower.setFromTriplets(entries.begin(), entries.end());
  return problem;
}

Eigen::VectorXd some_vector(Eigen::Index n) {
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) b[i] = std::sin(1.0 + static_cast<double>(i));
  return b;
}

TEST(NestedDissection, OrdersEveryUnknownOnceAndPartsOnlyMeetTheirAncestors) {
  const Problem problem = grid_problem(31, 2, 1);
  const EliminationForest forest = nested_dissection(problem.lower, problem.places, RunContext{});
  const std::size_t n = problem.places.size();
  ASSERT_EQ(forest.order.size(), n);
  std::vector<int> part_of(n, -1), parent(forest.parts.size(), -1);
  for (std::size_t p = 0; p < forest.parts.size(); ++p) {
    for (const int child : forest.parts[p].children) {
      EXPECT_LT(child, static_cast<int>(p));
      parent[child] = static_cast<int>(p);
    }
    for (int k = forest.parts[p].begin; k < forest.parts[p].end; ++k) {
      EXPECT_EQ(part_of[forest.order[k]], -1);
      part_of[forest.order[k]] = static_cast<int>(p);
    }
  }
  for (int c = 0; c < problem.lower.outerSize(); ++c)
    for (SparseMatrix::InnerIterator it(problem.lower, c); it; ++it) {
      int low = std::min(part_of[it.row()], part_of[c]);
      const int high = std::max(part_of[it.row()], part_of[c]);
      while (low >= 0 && low < high) low = parent[low];
      EXPECT_EQ(low, high);
    }
}

TEST(MultifrontalCholesky, SolvesWhatAMeshCouples) {
  for (const int side : {1, 3, 4, 20, 63}) {
    const Problem problem = grid_problem(side, 2, 7);
    const Eigen::VectorXd b = some_vector(problem.lower.rows());
    MultifrontalCholesky factor(problem.lower, problem.places, RunContext{});
    ASSERT_TRUE(factor.factorize(problem.lower, 0, RunContext{})) << side;
    const Eigen::VectorXd x = factor.solve(b, 1);
    EXPECT_LT((problem.lower.selfadjointView<Eigen::Lower>() * x - b).norm(), 1e-9 * b.norm()) << side;
  }
}

TEST(MultifrontalCholesky, DoesNotDependOnWhereTheUnknownsAre) {
  Problem problem = grid_problem(20, 1, 3);
  for (Vector3& p : problem.places) p.setZero();
  const Eigen::VectorXd b = some_vector(problem.lower.rows());
  MultifrontalCholesky factor(problem.lower, problem.places, RunContext{});
  ASSERT_TRUE(factor.factorize(problem.lower, 0.5, RunContext{}));
  const Eigen::VectorXd x = factor.solve(b, 1);
  EXPECT_LT((problem.lower.selfadjointView<Eigen::Lower>() * x + 0.5 * x - b).norm(), 1e-9 * b.norm());
}

TEST(MultifrontalCholesky, AnyNumberOfThreadsGivesTheSameBits) {
  const Problem problem = grid_problem(150, 2, 5);
  const auto solution = [&](int threads) {
    RunContext context;
    context.threads = threads;
    MultifrontalCholesky factor(problem.lower, problem.places, context);
    EXPECT_TRUE(factor.factorize(problem.lower, 0, context));
    return factor.solve(some_vector(problem.lower.rows()), threads);
  };
  const Eigen::VectorXd one = solution(1);
  for (const int threads : {2, 5}) EXPECT_EQ(solution(threads), one) << threads;
}

TEST(MultifrontalCholesky, TellsWhatIsNotPositiveDefinite) {
  Problem problem = grid_problem(20, 1, 3);
  problem.lower.coeffRef(210, 210) = -1;
  MultifrontalCholesky factor(problem.lower, problem.places, RunContext{});
  EXPECT_FALSE(factor.factorize(problem.lower, 0, RunContext{}));
  problem.lower.coeffRef(210, 210) = 10;
  EXPECT_TRUE(factor.factorize(problem.lower, 0, RunContext{}));
}

TEST(SparseSolve, OneOrderOfEliminationDoesForOtherValues) {
  for (const int sheets : {1, 60}) {  // by columns, and by fronts
    const Problem problem = grid_problem(20, sheets, 1);
    SparseMatrix other = problem.lower;
    for (int i = 0; i < other.rows(); ++i) other.coeffRef(i, i) *= 3;
    const Eigen::VectorXd b = some_vector(other.rows());
    SparseFactor factor(problem.lower, problem.places, RunContext{});
    for (const SparseMatrix* lower : {&problem.lower, &std::as_const(other)})
      EXPECT_TRUE(solve_sparse(*lower, b, factor, RunContext{}) == solve_sparse(*lower, b, problem.places, RunContext{}));
  }
}

TEST(SparseSolve, SolvesAndSurvivesSingularSystems) {
  const int n = 50;  // a path's Laplacian: singular, but the right side has no share of its kernel
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<Vector3> places(n);
  for (int i = 0; i < n; ++i) places[i] = Vector3(i, 0, 0);
  for (int i = 0; i + 1 < n; ++i) {
    entries.emplace_back(i, i, 1);
    entries.emplace_back(i + 1, i + 1, 1);
    entries.emplace_back(i + 1, i, -1);
  }
  SparseMatrix lower(n, n);
  lower.setFromTriplets(entries.begin(), entries.end());
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  b[0] = 1;
  b[n - 1] = -1;
  const Eigen::VectorXd x = solve_sparse(lower, b, places, RunContext{});
  EXPECT_LT((lower.selfadjointView<Eigen::Lower>() * x - b).norm(), 1e-6);
  const SparseMatrix nothing(n, n);
  EXPECT_TRUE(solve_sparse(nothing, b, places, RunContext{}).allFinite());
}

}  // namespace
}  // namespace hybrid_quad
