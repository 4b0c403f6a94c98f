#include "hybrid_quad/features/crease_clarity.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

namespace {

constexpr int kMostFaces = 2000;  ///< of one side; bounds the work where triangles are tiny

double angle_between(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

CreaseClarity::CreaseClarity(const TriangleMesh& mesh, const std::vector<Vector3>& normals, const std::vector<char>& barriers)
    : mesh_(mesh), normals_(normals), barriers_(barriers), seen_(mesh.face_count(), 0) {}

double CreaseClarity::operator()(int h, double radius) {
  const int other = mesh_.opposite(h);
  const Vector3 middle = 0.5 * (mesh_.position(mesh_.from(h)) + mesh_.position(mesh_.to(h)));
  const double own = angle_between(normals_[h / 3], normals_[other / 3]);
  const double from_away = angle_between(mean_normal(h, middle, radius), mean_normal(other, middle, radius));
  const double larger = std::max(own, from_away);
  return larger > 0 ? std::min(own, from_away) / larger : 1;
}

Vector3 CreaseClarity::mean_normal(int h, const Vector3& middle, double radius) {
  ++round_;
  queue_.assign(1, h / 3);
  seen_[h / 3] = round_;
  Vector3 sum = Vector3::Zero();
  for (std::size_t next = 0; next < queue_.size() && next < kMostFaces; ++next) {
    const int f = queue_[next];
    sum += mesh_.area(f) * normals_[f];
    for (int e = 3 * f; e < 3 * f + 3; ++e) {
      if (barriers_[e] || mesh_.is_boundary(e)) continue;
      const int g = mesh_.opposite(e) / 3;
      if (seen_[g] == round_) continue;
      const Vector3 center =
          (mesh_.position(mesh_.from(3 * g)) + mesh_.position(mesh_.from(3 * g + 1)) + mesh_.position(mesh_.from(3 * g + 2))) / 3;
      if ((center - middle).squaredNorm() > radius * radius) continue;
      seen_[g] = round_;
      queue_.push_back(g);
    }
  }
  return sum;
}

}  // namespace hybrid_quad
