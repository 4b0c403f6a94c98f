#pragma once

#include <vector>

#include "hybrid_quad/guide_curves/guide_curves.h"

namespace hybrid_quad {

/// What it costs a vertex to move by d while its edges should keep to a guide:
///   constant - 2 pull . d + d . stiffness d.
struct GuidePull {
  Vector3 pull = Vector3::Zero();
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();

  double change(const Vector3& d) const { return d.dot(stiffness * d) - 2 * pull.dot(d); }
  /// Adds weight ((x + d / share) . axis)^2.
  void add(const Vector3& axis, double x, double share, double weight) {
    pull -= weight * x / share * axis;
    stiffness += weight / (share * share) * axis * axis.transpose();
  }
};

/// Lines that are to cross edges in the middle, at right angles.
class RingPulls {
 public:
  /// \param edges  with the line (one of `traces`) that crosses each
  RingPulls(const std::vector<GuideEdge>& edges, const std::vector<StrokeTrace>& traces, std::size_t vertex_count);

  /// Adds what the lines ask of vertex v. \param normal  of the surface there  \param size  an edge length
  void add_to(GuidePull& sum, int v, const std::vector<Vector3>& positions, const Vector3& normal, double size) const;

 private:
  std::vector<GuideEdge> edges_;
  std::vector<std::vector<int>> edges_of_;  // by vertex
  std::vector<GuideLine> lines_;            // by guide
};

}  // namespace hybrid_quad
