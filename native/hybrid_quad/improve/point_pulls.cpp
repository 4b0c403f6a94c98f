#include "hybrid_quad/improve/point_pulls.h"

namespace hybrid_quad {

void PointPulls::clear() {
  pulls_.clear();
  of_vertex_.clear();
}

void PointPulls::add(const Pull& pull) {
  for (const int v : pull.vertices) of_vertex_[v].push_back(static_cast<int>(pulls_.size()));
  pulls_.push_back(pull);
}

void PointPulls::add_to(GuidePull& sum, int v, const std::vector<Vector3>& positions, double size) const {
  const auto found = of_vertex_.find(v);
  if (found == of_vertex_.end()) return;
  for (const int i : found->second) {
    const Pull& pull = pulls_[i];
    Vector3 left = pull.point;
    double share = 0;
    for (int k = 0; k < 4; ++k) {
      left -= pull.shares[k] * positions[pull.vertices[k]];
      if (pull.vertices[k] == v) share = pull.shares[k];
    }
    const double weight = pull.weight * share / (size * size);
    sum.pull += weight * left;
    sum.stiffness += weight * share * Eigen::Matrix3d::Identity();
  }
}

}  // namespace hybrid_quad
