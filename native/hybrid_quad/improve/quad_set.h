#pragma once

#include <limits>
#include <vector>

#include "hybrid_quad/improve/edit_mesh.h"

namespace hybrid_quad {

/// Some quads of a mesh, where they are when the set is made, to be asked for the nearest of them: for so few that a tree would not pay.
class QuadSet {
 public:
  QuadSet(const EditMesh& mesh, const std::vector<int>& quads);

  struct Place {
    int quad = -1;
    int second = 1;  ///< the place is on the triangle of corners 0, this one and the next
    Vector3 position = Vector3::Zero();
    double distance = std::numeric_limits<double>::infinity();  ///< scene units
  };
  /// The place nearest to p, each quad being split along its first diagonal. Of what rounding alone tells apart, as on an edge of two
  /// quads, the first in the set. quad = -1 if the set is empty.
  Place nearest(const Vector3& p) const;

 private:
  struct Ball {
    int quad;
    Vector3 centre;
    double radius;
  };
  const EditMesh& mesh_;
  std::vector<Ball> balls_;
};

}  // namespace hybrid_quad
