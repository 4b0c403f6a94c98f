#include "hybrid_quad/frame_field/surface_curvature.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "hybrid_quad/frame_field/averaging_steps.h"
#include "hybrid_quad/frame_field/face_angles.h"

namespace hybrid_quad {

namespace {

/// Bending of a region, integrated: divided by the area it is the curvature tensor, with its directions swapped.
struct Bending {
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  double area = 0;
};

/// Angle between two faces with these normals, positive where the edge along which they meet is convex.
double fold_angle(const Vector3& here, const Vector3& there, const Vector3& along) {
  return std::atan2(here.cross(there).dot(along), here.dot(there));
}

std::vector<Bending> bending_of_faces(const WorkingSurface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<Bending> bending(mesh.face_count());
  std::vector<Vector3> normal(mesh.face_count());
  for (int f = 0; f < mesh.face_count(); ++f) {
    bending[f].area = mesh.area(f);
    normal[f] = mesh.normal(f);
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o < h || surface.features.is_feature(h)) continue;
    const Vector3 e = mesh.edge_vector(h);
    const double length = e.norm();
    if (!(length > 0)) continue;
    const Eigen::Matrix3d half = (0.5 * fold_angle(normal[h / 3], normal[o / 3], e / length) / length) * e * e.transpose();
    bending[h / 3].tensor += half;
    bending[o / 3].tensor += half;
  }
  return bending;
}

constexpr double kSpread = 0.73;  // quad edges
constexpr double kStep = 0.35;    // edges, on even triangles

/// One step of averaging with the neighbours.
void spread(const WorkingSurface& surface, std::vector<Bending>& bending) {
  const std::vector<Bending> before = bending;
  for (int h = 0; h < surface.mesh.halfedge_count(); ++h) {
    const int o = surface.mesh.opposite(h);
    if (o < 0 || surface.features.is_feature(h)) continue;
    bending[h / 3].tensor += before[o / 3].tensor;
    bending[h / 3].area += before[o / 3].area;
  }
  for (std::size_t f = 0; f < bending.size(); ++f) {
    bending[f].tensor /= 4;
    bending[f].area /= 4;
  }
}

PrincipalCurvature principal(const Bending& bending, const FaceBasis& axes) {
  PrincipalCurvature result;
  if (!(bending.area > 0)) return result;
  const Eigen::Matrix<double, 3, 2> plane = (Eigen::Matrix<double, 3, 2>() << axes.along, axes.across).finished();
  const Eigen::Matrix2d tensor = plane.transpose() * bending.tensor * plane / bending.area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(tensor);
  if (solver.info() != Eigen::Success || !solver.eigenvalues().allFinite()) return result;
  int strong = 0;
  if (std::abs(solver.eigenvalues()[1]) > std::abs(solver.eigenvalues()[0])) strong = 1;
  result.strong = solver.eigenvalues()[strong];
  result.weak = solver.eigenvalues()[1 - strong];
  // Edges run along the direction in which the surface does not bend there: the other eigenvector is the bent one.
  if (result.strong != result.weak) result.direction = plane * solver.eigenvectors().col(1 - strong);
  return result;
}

}  // namespace

std::vector<PrincipalCurvature> principal_curvatures(const WorkingSurface& surface) {
  std::vector<Bending> bending = bending_of_faces(surface);
  for (int step = averaging_steps(surface, kSpread, kStep); step > 0; --step) spread(surface, bending);
  std::vector<PrincipalCurvature> result(bending.size());
  for (int f = 0; f < surface.mesh.face_count(); ++f) result[f] = principal(bending[f], face_basis(surface.mesh, f));
  return result;
}

}  // namespace hybrid_quad
