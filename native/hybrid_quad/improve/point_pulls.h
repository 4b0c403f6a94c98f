#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "hybrid_quad/improve/edit_mesh.h"
#include "hybrid_quad/improve/quad_set.h"
#include "hybrid_quad/improve/ring_pulls.h"

namespace hybrid_quad {

/// Points that quads are to come nearer to, each by the place nearest to it.
class PointPulls {
 public:
  struct Pull {
    Vector3 point = Vector3::Zero();
    std::array<int, 4> vertices{-1, -1, -1, -1};  ///< of a quad
    std::array<double, 4> shares{0, 0, 0, 0};     ///< by which they give the place; their sum is 1
    double weight = 0;                            ///< of the squared distance, in edge lengths
  };

  void clear();
  void add(const Pull& pull);

  /// Adds what the points ask of vertex v. \param size  an edge length
  void add_to(GuidePull& sum, int v, const std::vector<Vector3>& positions, double size) const;

 private:
  std::vector<Pull> pulls_;
  std::unordered_map<int, std::vector<int>> of_vertex_;
};

/// A point's pull at a quad. Half of it acts on the place nearest to the point, half on the quad as a whole: by the place alone a single
/// corner gets ahead of the others, and the quad becomes a spike.
/// \param place  on the quad, as it is  \param weight  of the squared distance, in edge lengths
PointPulls::Pull pull_of_quad(const EditMesh& mesh, const QuadSet::Place& place, const Vector3& point, double weight);

}  // namespace hybrid_quad
