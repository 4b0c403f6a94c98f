#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/spanning_parameterization/lifted_grid.h"

namespace hybrid_quad {

/// Where a lifted grid folds over.
struct GridFolds {
  std::vector<char> face;  ///< #F: no dislocation, and det <= 0 or nearly
  int faces = 0;
  int feature_edges = 0;  ///< feature edges along which the coordinate does not grow
};

GridFolds find_folds(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
                     const LiftedGrid& grid);

/// The values that fit the frames best in the least-squares sense with the jumps and all constrained
/// coordinates fixed, so that slip spreads out; then again up to `stiffening_rounds` times with more weight
/// around folds. Keeps the least folded. Along grid directions the two coordinates never mix (a quarter turn
/// permutes them), so this is one sparse signed Laplacian of at most two unknowns a vertex.
GridFolds spread_slip(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
                      int stiffening_rounds, const RunContext& context, LiftedGrid& grid);

}  // namespace hybrid_quad
