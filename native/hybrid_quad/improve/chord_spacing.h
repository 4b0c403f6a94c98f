#pragma once

#include <vector>

#include "hybrid_quad/improve/curve_geometry.h"

namespace hybrid_quad {

/// Vertices in order along a curve. On an open curve the first and the last one stay where they are; on a closed one all may move,
/// and the first follows the last.
struct CurveSpacing {
  std::vector<double> arc;   ///< arc lengths, increasing (on a closed curve: cyclically, within one turn)
  std::vector<double> room;  ///< how far each may move either way; less than half of what is between it and its neighbours
};

/// Largest distance from the curve between two arc lengths to the straight line between its ends.
double chord_deviation(const CurveGeometry& curve, double from, double to);

/// The largest over all edges of a chain.
double largest_chord_deviation(const CurveGeometry& curve, const std::vector<double>& arc);

/// Arc lengths within everyone's room for which the largest deviation of the chords from the curve is nearly as small as can be: three
/// quarters of what could be gained are. It is measured on the polyline that the curve is: where that is coarse, much is gained by
/// chords that end in its points, which no measure of curvature tells. Moves are as small as that allows, and shared among neighbours.
std::vector<double> spaced_by_chords(const CurveGeometry& curve, const CurveSpacing& spacing);

}  // namespace hybrid_quad
