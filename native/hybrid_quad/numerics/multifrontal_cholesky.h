#pragma once

#include <Eigen/Core>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/numerics/nested_dissection.h"

namespace hybrid_quad {

/// A = L L^T for a symmetric positive definite matrix whose unknowns lie on a surface: multifrontal (Duff and Reid 1983)
/// over a nested dissection, so that nearly all work is done by dense kernels, and parts that do not touch are eliminated at
/// the same time. For n unknowns it stores about n log n numbers, and counts n^(3/2) operations, many to the nanosecond.
class MultifrontalCholesky {
 public:
  /// \param places  where the unknowns are, one for each; see nested_dissection
  MultifrontalCholesky(const SparseMatrix& lower, const std::vector<Vector3>& places, const RunContext& context);

  /// Factorizes A + shift I. \param lower with the pattern that the constructor saw
  /// \return false if a pivot is not positive
  bool factorize(const SparseMatrix& lower, double shift, const RunContext& context);
  /// \pre factorize() succeeded
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side, int threads) const;

 private:
  /// A part's unknowns and those behind it that they are coupled with.
  struct Front {
    int begin = 0, end = 0;       ///< places in the order of elimination
    std::vector<int> beyond;      ///< ascending, all >= end
    std::vector<int> children;
    Eigen::MatrixXd column;       ///< of L: the own block (its lower triangle), then the rows of `beyond`

    int own() const { return end - begin; }
  };

  /// What a front takes from an unknown behind it.
  struct Taken {
    int place;
    double value;
  };

  void find_couplings();
  void place_entries(const SparseMatrix& lower);
  void plan_tasks();
  bool eliminate(std::size_t which, double shift, std::vector<Eigen::MatrixXd>& left_over);
  int task_begin(int task) const { return task > 0 ? task_end_[task - 1] : 0; }
  void solve_forwards(int task, std::vector<std::vector<Taken>>& taken, Eigen::VectorXd& x) const;
  void solve_backwards(int task, Eigen::VectorXd& x) const;

  std::vector<int> place_;               ///< unknown to its place in the order of elimination
  std::vector<Front> fronts_;            ///< children before their parents
  std::vector<int> first_, row_, entry_; ///< the reordered lower triangle by columns; entries of the given one
  std::vector<double> value_;
  std::vector<int> task_end_;     ///< fronts of task t end here and begin where those of t - 1 end
  std::vector<int> task_parent_;  ///< the task that waits for t, -1: none
  std::vector<std::vector<int>> task_children_;  ///< ascending
};

}  // namespace hybrid_quad
