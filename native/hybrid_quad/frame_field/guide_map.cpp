#include "hybrid_quad/frame_field/guide_map.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

GuideMap::GuideMap(const TriangleMesh& mesh, const std::vector<Vector3>& corner_guides)
    : mesh_(&mesh), corner_(corner_guides.size(), {0, 0}) {
  for (std::size_t h = 0; h < corner_guides.size(); ++h) {
    if (corner_guides[h].isZero(0)) continue;
    const FaceBasis basis = face_basis(mesh, static_cast<int>(h) / 3);
    const Vector3 guide = corner_guides[h] / std::max(1.0, corner_guides[h].norm());
    const double x = guide.dot(basis.along), y = guide.dot(basis.across);
    corner_[h] = std::polar(std::hypot(x, y), 4 * std::atan2(y, x));
  }
}

Vector3 GuideMap::at(int f, const Vector3& p) const {
  const std::array<double, 3> weight = corner_weights_at(*mesh_, f, p);
  std::complex<double> mean(0, 0);
  for (int i = 0; i < 3; ++i) mean += weight[i] * corner_[3 * f + i];
  if (mean == std::complex<double>(0, 0)) return Vector3::Zero();
  const FaceBasis basis = face_basis(*mesh_, f);
  const double angle = std::arg(mean) / 4;
  return std::abs(mean) * (std::cos(angle) * basis.along + std::sin(angle) * basis.across);
}

std::array<double, 3> corner_weights_at(const TriangleMesh& mesh, int f, const Vector3& p) {
  const Vector3 twice = mesh.area_normal(f);
  std::array<double, 3> weight{};
  for (int i = 0; i < 3; ++i) {
    const int h = 3 * f + (i + 1) % 3;  // the edge opposite to corner i
    const double share = mesh.edge_vector(h).cross(p - mesh.position(mesh.from(h))).dot(twice) / twice.squaredNorm();
    weight[i] = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 1.0 / 3;
  }
  return weight;
}

}  // namespace hybrid_quad
