#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// How much of the surface's bend near an edge happens in that edge: 1 on a crease between smooth sides, near 0 where the
/// sides look alike from `radius` away (noise of a scan), in between on a rounded ridge. The bend seen from away is the
/// angle between the mean normals of the faces on either side, within `radius` of the edge's middle and without
/// crossing a barrier.
class CreaseClarity {
 public:
  /// \param normals #F, unit
  /// \param barriers 3 #F, symmetric: edges that bound a side; boundary edges do anyway
  /// The arguments are referred to, not copied.
  CreaseClarity(const TriangleMesh& mesh, const std::vector<Vector3>& normals, const std::vector<char>& barriers);

  /// \param h half-edge of an edge with two faces  \param radius  how far away the bend is seen from
  double operator()(int h, double radius);

 private:
  Vector3 mean_normal(int h, const Vector3& middle, double radius);

  const TriangleMesh& mesh_;
  const std::vector<Vector3>& normals_;
  const std::vector<char>& barriers_;
  std::vector<int> seen_, queue_;
  int round_ = 0;
};

}  // namespace hybrid_quad
