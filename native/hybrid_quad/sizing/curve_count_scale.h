#pragma once

#include "hybrid_quad/frame_field/frame_field.h"
#include "hybrid_quad/numerics/sparse_solve.h"

namespace hybrid_quad {

/// Lengthens and shortens frames around curves with an asked count so that each curve measures that many quads. The
/// logarithm of the factor is given on these curves and fades away within a few quads (a screened Poisson problem on the
/// vertices).
class CurveCountScale {
 public:
  explicit CurveCountScale(const WorkingSurface& surface);

  bool is_idle() const { return idle_; }
  void apply(FrameField& field, const RunContext& context) const;

 private:
  std::vector<double> log_factors(const FrameField& field) const;

  const WorkingSurface& surface_;
  bool idle_ = true;
  SparseMatrix matrix_;             ///< lower triangle
  std::vector<double> pin_weight_;  ///< #V
};

}  // namespace hybrid_quad
