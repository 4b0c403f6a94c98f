#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/regular_quads/grid_overlay.h"

namespace hybrid_quad {

/// The regular part of the quad mesh (paper 4.3): cells of the integer grid that are whole, that is, made of regular
/// pieces only, a disk, bounded by four unit sides.
struct RegularQuads {
  GridOverlay overlay;
  std::vector<int> piece_cell;                ///< #pieces: the quad it is part of, or -1 (singular region)
  std::vector<std::array<int, 4>> side;       ///< #quads: first overlay half-edge of each side, counterclockwise
};

RegularQuads extract_regular_quads(const WorkingSurface& surface, const FrameField& frames,
                                   const SpanningParameterization& param, const RunContext& context);

/// The last half-edge of the chain of border half-edges that starts at k and ends at the next grid point.
/// \param is_inside  tells whether a piece belongs to the same cell or patch
template <class IsInside>
int next_border_halfedge(const GridOverlay& overlay, int k, IsInside is_inside) {
  int n = overlay.next(k);
  while (!overlay.on_isoline[n] && overlay.opposite[n] >= 0 && is_inside(overlay.piece_of[overlay.opposite[n]]))
    n = overlay.next(overlay.opposite[n]);
  return n;
}

/// Every cell has four grid points of alternating sign; between grid points no more than two borders meet, so that the chain of
/// a grid edge is the same from both of its sides.
std::vector<std::string> violations_of(const RegularQuads& quads);

}  // namespace hybrid_quad
