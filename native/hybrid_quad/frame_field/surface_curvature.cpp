#include "hybrid_quad/frame_field/surface_curvature.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "hybrid_quad/base/parallel.h"
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

/// Half of what the edge of half-edge h bends, on either side.
Eigen::Matrix3d half_of_edge(const TriangleMesh& mesh, const std::vector<Vector3>& normal, int h) {
  const Vector3 e = mesh.edge_vector(h);
  const double length = e.norm();
  if (!(length > 0)) return Eigen::Matrix3d::Zero();
  return (0.5 * fold_angle(normal[h / 3], normal[mesh.opposite(h) / 3], e / length) / length) * e * e.transpose();
}

std::vector<Bending> bending_of_faces(const WorkingSurface& surface, const RunContext& context) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<Bending> bending(mesh.face_count());
  std::vector<Vector3> normal(mesh.face_count());
  parallel_chunks(mesh.face_count(), context, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) {
      bending[f].area = mesh.area(f);
      normal[f] = mesh.normal(f);
    }
  });
  const auto bends = [&](int h) { return mesh.opposite(h) > h && !surface.features.is_feature(h); };
  std::vector<Eigen::Matrix3d> half(mesh.halfedge_count());
  parallel_chunks(mesh.halfedge_count(), context, [&](int begin, int end) {
    for (int h = begin; h < end; ++h)
      if (bends(h)) half[h] = half_of_edge(mesh, normal, h);
  });
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (!bends(h)) continue;
    bending[h / 3].tensor += half[h];
    bending[mesh.opposite(h) / 3].tensor += half[h];
  }
  return bending;
}

constexpr double kSpread = 0.73;  // quad edges
constexpr double kStep = 0.35;    // edges, on even triangles

/// One step of averaging with the neighbours.
void spread(const WorkingSurface& surface, const std::vector<Bending>& before, std::vector<Bending>& after,
            const RunContext& context) {
  parallel_chunks(surface.mesh.face_count(), context, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) {
      Bending sum = before[f];
      for (int h = 3 * f; h < 3 * f + 3; ++h) {
        const int o = surface.mesh.opposite(h);
        if (o < 0 || surface.features.is_feature(h)) continue;
        sum.tensor += before[o / 3].tensor;
        sum.area += before[o / 3].area;
      }
      after[f].tensor = sum.tensor / 4;
      after[f].area = sum.area / 4;
    }
  });
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

std::vector<PrincipalCurvature> principal_curvatures(const WorkingSurface& surface, const RunContext& context) {
  std::vector<Bending> bending = bending_of_faces(surface, context), next(bending.size());
  for (int step = averaging_steps(surface, kSpread, kStep); step > 0; --step) {
    spread(surface, bending, next, context);
    bending.swap(next);
  }
  std::vector<PrincipalCurvature> result(bending.size());
  parallel_chunks(surface.mesh.face_count(), context, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) result[f] = principal(bending[f], face_basis(surface.mesh, f));
  });
  return result;
}

}  // namespace hybrid_quad
