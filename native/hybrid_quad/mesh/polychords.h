#pragma once

#include <vector>

#include "hybrid_quad/mesh/quad_complex.h"

namespace hybrid_quad {

/// Dual strips: a polychord enters every quad through a side and leaves through the opposite one; it may
/// cross itself.
struct Polychords {
  std::vector<int> of_dart;  ///< 4 #Q
  std::vector<int> length;   ///< crossings of quads
};
Polychords trace_polychords(const QuadComplex& complex);

/// The region (anchor of free vertices) of every quad, spread from free vertices between curves; -1 where
/// there is none.
std::vector<int> quad_regions(const QuadComplex& complex);

/// Splits polychords lengthwise: each quad crossed once becomes two, crossed twice four; sides crossed get
/// their middle as a vertex, on the curve where the side is a feature. \param chosen  by polychord: whether
/// to split it
QuadComplex split_polychords(const QuadComplex& complex, const Polychords& polychords,
                             const std::vector<char>& chosen);

}  // namespace hybrid_quad
