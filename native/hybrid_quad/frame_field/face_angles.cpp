#include "hybrid_quad/frame_field/face_angles.h"

#include <cmath>

#include "hybrid_quad/base/parallel.h"

namespace hybrid_quad {

namespace {

constexpr double kPi = 3.14159265358979323846;

double angle_between(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

FaceBasis face_basis(const TriangleMesh& mesh, int f) {
  FaceBasis basis;
  basis.normal = mesh.normal(f);
  Vector3 along = mesh.edge_vector(3 * f);
  along -= along.dot(basis.normal) * basis.normal;
  const double length = along.norm();
  if (length > 0) {
    basis.along = along / length;
  } else {
    basis.along = basis.normal.unitOrthogonal();
  }
  basis.across = basis.normal.cross(basis.along);
  return basis;
}

FaceAngles::FaceAngles(const TriangleMesh& mesh, const RunContext& context)
    : corner_(mesh.halfedge_count()), direction_(mesh.halfedge_count()) {
  const auto measure = [&](int f) {
    const Vector3 e0 = mesh.edge_vector(3 * f), e1 = mesh.edge_vector(3 * f + 1), e2 = mesh.edge_vector(3 * f + 2);
    double* corner = &corner_[3 * f];
    corner[0] = angle_between(e0, -e2);
    corner[1] = angle_between(e1, -e0);
    corner[2] = kPi - corner[0] - corner[1];
    direction_[3 * f] = 0;
    direction_[3 * f + 1] = kPi - corner[1];
    direction_[3 * f + 2] = direction_[3 * f + 1] + kPi - corner[2];
  };
  parallel_chunks(mesh.face_count(), context, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) measure(f);
  });
}

double FaceAngles::transport(int h, int opposite) const { return direction_[opposite] + kPi - direction_[h]; }

}  // namespace hybrid_quad
