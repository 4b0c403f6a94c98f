#pragma once

#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// A polygon to be filled with quads: its corners in counterclockwise order (an even number >= 4), each with
/// the surface's unit normal there.
struct BorderPolygon {
  std::vector<Vector3> positions;
  std::vector<Vector3> normals;
  double target_length = 0;
};

struct DiskFill {
  std::vector<Vector3> positions;         ///< the polygon's corners, then vertices inside
  std::vector<std::array<int, 4>> quads;  ///< counterclockwise
  double cost = 0;                        ///< of the corner angles and sizes; 0 for unit squares
};

/// The cheapest division of a polygon into quads and stars (k quads around one inner vertex, k = 3, 4, 5):
/// dynamic programming over its chords. \pre an even number of corners, 4 .. 16
DiskFill fill_disk(const BorderPolygon& polygon);

}  // namespace hybrid_quad
