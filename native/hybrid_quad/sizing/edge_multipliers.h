#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/frame_field/frame_field.h"
#include "hybrid_quad/numerics/sparse_matrix.h"
#include "hybrid_quad/sizing/correction_costs.h"

namespace hybrid_quad {

/// The correction for any lambda: solved for one multiplier per edge and row, which is a screened Laplacian on edges with a
/// third of the primal system's fill (FEW_SINGULARITIES 3).
class EdgeMultipliers {
 public:
  EdgeMultipliers(const TriangleMesh& mesh, const FrameField& field, const CorrectionCosts& costs);

  /// \param costs   as in the constructor, with other stiffnesses perhaps
  /// \param lambda  what X - I costs, beside the curl; no unit
  /// \param x       gets #F matrices {X00, X01, X10, X11}, which act on the grid vectors of their faces
  /// \throws Cancelled if the caller asked to stop
  void solve(const CorrectionCosts& costs, double lambda, std::vector<std::array<double, 4>>& x, const RunContext& context) const;

 private:
  /// Row r of X_f enters a constraint as  sum of coefficients times (X_f)_{r0}, (X_f)_{r1}.
  struct RowTerm {
    int constraint;
    Vector2 coefficients;
  };

  int add(double softness, const Vector3& middle);
  void put(int node, int constraint, const Vector2& coefficients) { terms_[node][term_count_[node]++] = {constraint, coefficients}; }
  void add_edge(const FrameField& field, const TriangleMesh& mesh, int h, double weight);
  void assemble(const CorrectionCosts& costs, double lambda, SparseMatrix& matrix, Eigen::VectorXd& right_side) const;

  std::vector<std::array<RowTerm, 6>> terms_;  ///< per node: at most an edge and a feature on each of three sides
  std::vector<int> term_count_;
  std::vector<double> compliance_;
  std::vector<Vector3> place_;  ///< per constraint: the middle of its edge
};

}  // namespace hybrid_quad
