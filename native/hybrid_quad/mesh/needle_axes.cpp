#include "hybrid_quad/mesh/needle_axes.h"

#include <Eigen/Eigenvalues>

namespace hybrid_quad {

namespace {

using Matrix3 = Eigen::Matrix3d;

constexpr double kNeedle = 100;      // times as long as high
constexpr double kFewest = 0.01;     // of the faces
constexpr double kMostOther = 0.01;  // of the squared lengths across the needles' direction, to those along it: some six degrees

}  // namespace

NeedleAxes::NeedleAxes(const TriangleMesh& mesh) : along_(mesh.face_count(), Vector3::Zero()), square_(mesh.face_count(), 0) {
  int needles = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto& corners = mesh.face(f);
    Vector3 longest = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      const Vector3 side = mesh.position(corners[(i + 1) % 3]) - mesh.position(corners[i]);
      if (side.squaredNorm() > longest.squaredNorm()) longest = side;
    }
    square_[f] = longest.squaredNorm();
    const double most = square_[f] / kNeedle;
    if (mesh.area_normal(f).squaredNorm() >= most * most) continue;  // twice the area: length by height
    along_[f] = longest;
    ++needles;
  }
  if (needles < kFewest * mesh.face_count()) along_.clear();
}

void NeedleAxes::add_to(Matrix3& group, int f) const {
  if (along_[f].isZero(0)) group.diagonal().array() += square_[f] / 3;
  else group += along_[f] * along_[f].transpose();
}

Matrix3 NeedleAxes::turn_of(const Matrix3& group) {
  constexpr double kAlong = 1 - 1e-12;  // of a unit vector: a coordinate axis
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(group);  // the largest comes last
  const bool is_one_direction = axes.info() == Eigen::Success && axes.eigenvalues()[1] < kMostOther * axes.eigenvalues()[2];
  if (!is_one_direction || axes.eigenvectors().col(2).cwiseAbs().maxCoeff() > kAlong) return Matrix3::Identity();
  Matrix3 turn;
  for (int i = 0; i < 3; ++i) turn.row(i) = axes.eigenvectors().col(2 - i).transpose();
  return turn;
}

}  // namespace hybrid_quad
