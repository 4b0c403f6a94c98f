#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "hybrid_quad/mesh/mesh_builder.h"

namespace hybrid_quad {

/// How polygons of more than three corners were cut into triangles, so that copies of one are cut alike, whichever corner they
/// start from and whichever way round they go: then their triangles tell that they are copies.
class PolygonCuts {
 public:
  /// \param positions  of the soup's vertices; those at one place exactly count as one
  PolygonCuts(const std::vector<Vector3>& positions, const PolygonSoup& soup);

  /// The triangles of a polygon as those of one that was kept and has the same corners in space, one after the other; empty
  /// where there is none. \param corners  the polygon's, no two in a row the same
  std::vector<std::array<int, 3>> like_a_copy(int polygon, const std::vector<int>& corners) const;

  /// Keeps triangles for copies of the polygon that are still to come.
  void keep(int polygon, const std::vector<int>& corners, const std::vector<std::array<int, 3>>& triangles);

 private:
  struct Cut {
    std::vector<int> corners;
    std::vector<std::array<int, 3>> triangles;
  };

  const std::vector<Vector3>& positions_;
  std::vector<std::uint64_t> key_;  ///< of each polygon that may have a copy, else 0: the same for the same corners in any order
  std::unordered_map<std::uint64_t, std::vector<Cut>> cuts_;
};

}  // namespace hybrid_quad
