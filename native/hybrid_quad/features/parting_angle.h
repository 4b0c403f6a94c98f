#pragma once

#include <vector>

namespace hybrid_quad {

/// An edge between two faces.
struct BentEdge {
  double angle;   ///< between the faces' normals, degrees
  double length;  ///< scene units
};

/// The sharp angle, or where that tells nothing apart, the least angle above it that does, degrees.
///
/// On scans and sculpts there are ever fewer edges of ever larger angles: those above any limit are the tail of a rough surface, and
/// stand out from what is below it by nothing. Creases do, by many edges above the limit and few just below it.
/// \param sharp_angle  degrees
double parting_angle(const std::vector<BentEdge>& edges, double sharp_angle);

}  // namespace hybrid_quad
