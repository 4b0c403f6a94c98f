#pragma once

#include <array>
#include <optional>
#include <vector>

#include "hybrid_quad/frame_field/frame_field.h"
#include "hybrid_quad/numerics/sparse_factor.h"
#include "hybrid_quad/numerics/sparse_matrix.h"
#include "hybrid_quad/sizing/correction_costs.h"
#include "hybrid_quad/sizing/disk_cut.h"

namespace hybrid_quad {

/// The correction for small lambda: on a surface cut to disks the corrected frames are the gradients of two functions, so
/// that edges measure the same from both sides but where they are cut, and there to within lambda. A quarter of
/// the corrections' unknowns, a third of EdgeMultipliers', and couplings between neighbouring vertices only. The energy is that of
/// curl_correction, with infinite weight on edges that are not cut (docs/decisions/0036).
class VertexPotentials {
 public:
  VertexPotentials(const TriangleMesh& mesh, const FrameField& field, const CorrectionCosts& costs);

  /// \param costs   as in the constructor, with other stiffnesses perhaps
  /// \param lambda  what X - I costs, beside the curl of cut edges; no unit
  /// \param x       gets #F matrices {X00, X01, X10, X11}, which act on the grid vectors of their faces
  /// \throws Cancelled if the caller asked to stop
  void solve(const CorrectionCosts& costs, double lambda, std::vector<std::array<double, 4>>& x, const RunContext& context);

 private:
  /// Row X_r of a face's correction is this times what function r grows by along the face's first two edges.
  using Gradient = Eigen::Matrix2d;
  /// A difference of values at nodes, one of them for each coordinate, that should vanish.
  struct Spring {
    std::array<int, 4> unknown;
    std::array<double, 4> coefficient;
    double softness;
  };

  int unknown(int corner, int row) const { return 2 * cut_.node[corner] + row; }
  void assemble(const CorrectionCosts& costs, double lambda, SparseMatrix& matrix, Eigen::VectorXd& right_side) const;
  void add_springs(const TriangleMesh& mesh, const FrameField& field, const CorrectionCosts& costs);

  DiskCut cut_;
  std::vector<Gradient> gradient_;  ///< #F
  std::vector<Spring> springs_;
  std::vector<Vector3> place_;  ///< per unknown
  std::optional<SparseFactor> factor_;  ///< the first solution makes it: other stiffnesses have the same pattern
};

}  // namespace hybrid_quad
