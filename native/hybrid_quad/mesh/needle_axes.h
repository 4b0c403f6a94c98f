#pragma once

#include <Eigen/Core>
#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Which way needles lie: triangles hundreds of times as long as high. A box along the coordinate axes around a slanting needle is
/// as wide as it is long, and the boxes of needles side by side hold each other; boxes along them do not.
class NeedleAxes {
 public:
  explicit NeedleAxes(const TriangleMesh& mesh);
  /// Whether the mesh has too few needles to mind.
  bool empty() const { return along_.empty(); }
  /// Adds what face f says about the direction of the needles in a group of faces.
  void add_to(Eigen::Matrix3d& group, int f) const;
  /// A rotation to axes of which the first lies along the needles of a group; the identity where others or several
  /// directions prevail, or a coordinate axis.
  static Eigen::Matrix3d turn_of(const Eigen::Matrix3d& group);

 private:
  std::vector<Vector3> along_;  ///< by face: the longest edge of a needle, else zero
  std::vector<double> square_;  ///< by face: the squared longest edge
};

}  // namespace hybrid_quad
