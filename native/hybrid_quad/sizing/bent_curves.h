#pragma once

#include <vector>

#include "hybrid_quad/features/features.h"

namespace hybrid_quad {

/// Shortens the target lengths of a curve's vertices where it bends within an edge, so that chords that long are near it: a chord
/// of length h is h^2 / (8 r) from its arc of radius r. Curves no longer than an edge are left to feature_sized_lengths.
/// \param length  asked quad edge length (scene units)
/// \param target  #V of the mesh (scene units), lowered
void limit_lengths_of_bends(const TriangleMesh& mesh, const FeatureCurve& curve, double length, std::vector<double>& target);

}  // namespace hybrid_quad
