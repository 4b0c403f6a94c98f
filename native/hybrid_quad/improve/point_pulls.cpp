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

PointPulls::Pull pull_of_quad(const EditMesh& mesh, const QuadSet::Place& place, const Vector3& point, double weight) {
  constexpr double kOnWhole = 0.5;
  PointPulls::Pull pull;
  pull.point = point;
  pull.vertices = mesh.quad(place.quad);
  pull.weight = weight;
  const int k = place.second;
  const Vector3& a = mesh.positions[pull.vertices[0]];
  const Vector3 b = mesh.positions[pull.vertices[k]] - a, c = mesh.positions[pull.vertices[k + 1]] - a, d = place.position - a;
  const double bb = b.squaredNorm(), cc = c.squaredNorm(), bc = b.dot(c), determinant = bb * cc - bc * bc;
  if (determinant > 0) {
    pull.shares[k] = (cc * d.dot(b) - bc * d.dot(c)) / determinant;
    pull.shares[k + 1] = (bb * d.dot(c) - bc * d.dot(b)) / determinant;
  }
  pull.shares[0] = 1 - pull.shares[k] - pull.shares[k + 1];
  for (double& share : pull.shares) share = (1 - kOnWhole) * share + kOnWhole / 4;
  return pull;
}

}  // namespace hybrid_quad
