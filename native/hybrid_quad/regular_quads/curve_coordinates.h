#pragma once

#include <cstdint>
#include <vector>

#include "hybrid_quad/spanning_parameterization/spanning_parameterization.h"

namespace hybrid_quad {

/// A coordinate along every feature curve whose integer points are the quad vertices on that curve. Both sides of a
/// curve read it, so quads on either side meet in the same vertices (docs/guarantee.md, step 4).
struct CurveCoordinates {
  struct Curve {
    std::vector<std::int64_t> position;  ///< at the curve's vertices, strictly increasing, kGridUnit = one quad edge
    int parity = 0;                      ///< the Morse function is (-1)^(k + parity) at the integer point k
  };
  std::vector<Curve> curves;        ///< as in FeatureGraph::curves
  std::vector<int> halfedge_index;  ///< 3 #F: place of a feature half-edge's edge in its curve, or -1
  std::vector<char> is_altered;     ///< 3 #F: the parameterization folded or jumped here and the coordinate was made anew
  int altered_edges = 0;
  int altered_counts = 0;           ///< curves that had to be given another number of quads (none would vanish)
};

/// The tangential coordinate of the parameterization where it increases along the curve and the charts beside it continue each
/// other; arc length between the nearest sound vertices where they do not. A curve between corners has at least one quad edge, a closed one at least four (an
/// even number); the parity is that of its ends. Where that allows it, a curve with an asked count gets exactly that many.
CurveCoordinates build_curve_coordinates(const WorkingSurface& surface, const FrameField& frames,
                                         const SpanningParameterization& param);

}  // namespace hybrid_quad
