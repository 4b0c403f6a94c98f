#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <vector>

#include "hybrid_quad/numerics/sparse_solve.h"

namespace hybrid_quad {

/// An approximate inverse of a symmetric positive definite matrix: multigrid over aggregates of about four unknowns that
/// are coupled most strongly, carried with the sign of their coupling (so that a Laplacian on values up to sign is a
/// Laplacian like any other), with the K-cycle of Notay (2008; Notay and Vassilevski 2008). Linear time a cycle.
class AggregationMultigrid {
 public:
  /// \param lower  lower triangle of the matrix
  explicit AggregationMultigrid(const SparseMatrix& lower);

  /// y = A x
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const { levels_[0].multiply(x, y); }
  /// x ~ A^-1 b; not a linear map, so the outer iteration has to be a flexible one.
  void precondition(const Eigen::VectorXd& b, Eigen::VectorXd& x) { cycle(0, b, x); }

 private:
  struct Level {
    std::vector<int> row_begin, column;
    std::vector<double> value;
    Eigen::VectorXd diagonal;
    std::vector<int> aggregate;
    std::vector<double> sign;
    // Work space of the cycle on this level.
    Eigen::VectorXd residual, right_side, solution, direction, image, second, second_image;

    int size() const { return static_cast<int>(diagonal.size()); }
    void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
    void smooth_forward(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;
    void smooth_backward(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;
  };
  static int pair_unknowns(Level& level);
  static Level coarsened(const Level& level, int count);
  void cycle(std::size_t l, const Eigen::VectorXd& b, Eigen::VectorXd& x);
  void solve_coarse(std::size_t l);

  std::vector<Level> levels_;
  Eigen::LDLT<Eigen::MatrixXd> coarsest_;
  bool coarsest_is_dense_ = false;
};

}  // namespace hybrid_quad
