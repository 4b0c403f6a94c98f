#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Closed curves of many edges that meet no other and go around evenly, as the rims of holes and pins do: no chance makes these, however
/// small they are (docs/decisions/0007).
struct Rounds {
  std::vector<double> length;    ///< of every round (scene units)
  std::vector<int> of_halfedge;  ///< 3 #F: the round that an edge is part of, the same on both sides of it; -1: of none
};

/// \param is_part   3 #F, symmetric: edges that rounds are made of; the boundary is none
/// \param is_other  3 #F, symmetric: edges that no round meets, besides the boundary
Rounds find_rounds(const TriangleMesh& mesh, const std::vector<char>& is_part, const std::vector<char>& is_other);

}  // namespace hybrid_quad
