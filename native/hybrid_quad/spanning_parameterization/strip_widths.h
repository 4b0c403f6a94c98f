#pragma once

#include <vector>

#include "hybrid_quad/spanning_parameterization/lifted_grid.h"

namespace hybrid_quad {

/// The widths of narrow strips between features, and what a dislocation that crosses an edge does to them: a strip that
/// loses its last row of quads collapses from end to end.
class StripWidths {
 public:
  StripWidths(const TriangleMesh& mesh, const FrameField& frames, const GridMeasure& measure,
              const LiftedGrid& grid, int least_rows);

  /// Whether every strip keeps the least number of rows, or what fewer it has, when Burgers vector b leaves over half-edge h.
  bool allow(int h, const IntVector2& b) const;
  void cross(int h, const IntVector2& b);

 private:
  struct Effect {
    int strip;
    IntVector2 gain;  ///< change of the width = gain . Burgers vector
  };
  int least_rows_;
  std::vector<int> width_;
  std::vector<int> first_;  ///< 3 #F + 1, into effects_
  std::vector<Effect> effects_;
};

}  // namespace hybrid_quad
