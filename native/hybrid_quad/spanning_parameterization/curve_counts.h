#pragma once

#include <vector>

#include "hybrid_quad/spanning_parameterization/lifted_grid.h"

namespace hybrid_quad {

/// Corners whose parity is settled: u + v is even (sign 1) or odd (-1).
struct CornerSigns {
  std::vector<int> vertex;
  std::vector<int> sign;
};

/// Psi fixes how many quad edges a curve gets only up to twos: its number is even where both corners have the same sign.
/// The signs that make the asked counts possible, in every set of corners that such curves connect those that most
/// corners have already.
CornerSigns corner_signs(const FeatureGraph& features, const std::vector<PhasePair>& psi);

void impose(const CornerSigns& signs, std::vector<PhasePair>& psi);

/// Gives every curve the quad edges that were asked for, or at least the fewest that it may have, two at a time
/// (parity is Psi's), where the lift is furthest from the frames. Sets curve_count.
void settle_curve_counts(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
                         LiftedGrid& grid);

/// How many quad edges a curve may have, both included.
struct CountRange {
  int fewest, most;
};

/// #curves: what moving dislocations may make of each. No fewer than seven tenths of what the frames measure, nor than it takes for
/// chords within .12 edges of its bends, where frames measure so many. Where there are asked counts, exactly these, and for the others
/// not many more than the frames measure either: they would pay for the asked ones.
std::vector<CountRange> allowed_counts(const WorkingSurface& surface, const GridMeasure& measure);

/// #F: whether a face is within a few quads of a curve with an asked count; empty where there is no such curve.
std::vector<char> faces_near_counts(const WorkingSurface& surface, const FrameField& frames);

}  // namespace hybrid_quad
