#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "hybrid_quad/frame_field/frame_topology.h"
#include "hybrid_quad/frame_field/surface_curvature.h"
#include "hybrid_quad/pipeline/wishes.h"

namespace hybrid_quad {

namespace {

using Frame = std::array<Vector3, 2>;
using Plane = Eigen::Matrix<double, 3, 2>;  ///< columns: a face's basis

Plane plane_of(const FaceBasis& basis) { return (Plane() << basis.along, basis.across).finished(); }

/// Where the middle of every face of the working surface lies on the component: a face, and weights of its corners.
struct Place {
  int face = -1;
  Vector3 position = Vector3::Zero();
  std::array<double, 3> weight{0, 0, 0};
};

Place place_of(const SurfaceIndex& index, const Vector3& p, const Vector3& normal) {
  SurfaceIndex::Filter filter;
  filter.normal = normal;
  filter.min_cosine = 0;
  SurfacePoint nearest = index.nearest(p, filter);
  if (nearest.face < 0) nearest = index.nearest(p);
  Place place;
  if (nearest.face < 0) return place;
  place.face = nearest.face;
  place.weight = corner_weights_at(index.mesh(), nearest.face, nearest.position);
  place.position = nearest.position;
  return place;
}

std::vector<Place> places_of(const WorkingSurface& surface, const SurfaceIndex& index) {
  std::vector<Place> places(surface.mesh.face_count());
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    const auto& t = surface.mesh.face(f);
    const Vector3 middle = (surface.mesh.position(t[0]) + surface.mesh.position(t[1]) + surface.mesh.position(t[2])) / 3;
    places[f] = place_of(index, middle, surface.mesh.normal(f));
  }
  return places;
}

/// A frame in a face's plane, right-handed; not ok where it vanishes there.
struct PlaneFrame {
  Eigen::Matrix2d edges = Eigen::Matrix2d::Identity();  ///< columns
  bool ok = false;
};

PlaneFrame in_plane(const Frame& frame, const Plane& plane) {
  PlaneFrame result;
  result.edges << plane.transpose() * frame[0], plane.transpose() * frame[1];
  if (result.edges.determinant() < 0) result.edges.col(1) *= -1;
  result.ok = result.edges.determinant() > 1e-3 * result.edges.squaredNorm() / kMostFrameStretch;
  return result;
}

/// The square of the symmetric factor of edges = stretch * rotation: the same for (e1, e2) and (e2, -e1).
Eigen::Matrix2d squared_stretch(const PlaneFrame& frame) {
  if (!frame.ok) return Eigen::Matrix2d::Identity();
  return frame.edges * frame.edges.transpose() / frame.edges.determinant();
}

Eigen::Matrix2d root_of(const Eigen::Matrix2d& square) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(square).operatorSqrt();
}

/// Along the bent direction shorter, along the other longer, by at most `most`; only as far as the face's axes lie along them.
Eigen::Matrix3d stretch_along_curvature(const PrincipalCurvature& curvature, double length, double most, const Vector3& u,
                                        const Vector3& v) {
  constexpr double kFlat = 0.05;  // a bend of radius 20 h asks for nothing
  const double ratio = std::sqrt((std::abs(curvature.strong) * length + kFlat) / (std::abs(curvature.weak) * length + kFlat));
  const double along_u = curvature.direction.dot(u), along_v = curvature.direction.dot(v);
  const double share = along_u * along_u - along_v * along_v;  // cos of twice the angle
  const double half = 0.5 * std::log(std::min(ratio, most)) * share;
  return std::exp(-half) * u * u.transpose() + std::exp(half) * v * v.transpose();
}

/// By that ratio along what bends clearly less, as a tube does along its axis, also where it turns; less so where it bends alike, as a tip does.
Eigen::Matrix3d stretch_along_tube(const PrincipalCurvature& curvature, double ratio, const Vector3& u, const Vector3& v) {
  constexpr double kClear = 0.3;  // difference of the curvatures over their sum
  const double strong = std::abs(curvature.strong), weak = std::abs(curvature.weak);
  const double clear = strong + weak > 0 ? std::min(1.0, (strong - weak) / (strong + weak) / kClear) : 0;
  const double along_u = curvature.direction.dot(u), along_v = curvature.direction.dot(v);
  const double half = 0.5 * std::log(ratio) * clear * (along_u * along_u - along_v * along_v);
  return std::exp(-half) * u * u.transpose() + std::exp(half) * v * v.transpose();
}

}  // namespace

GuideMap guides_on(const Wishes& wishes, const TriangleMesh& finer) {
  if (wishes.guides.empty()) return {};
  std::vector<Vector3> corners(finer.halfedge_count());
  for (int f = 0; f < finer.face_count(); ++f) {
    const auto& t = finer.face(f);
    const Vector3 middle = (finer.position(t[0]) + finer.position(t[1]) + finer.position(t[2])) / 3;
    const int face = place_of(*wishes.index, middle, finer.normal(f)).face;
    for (int i = 0; i < 3; ++i) corners[3 * f + i] = wishes.guides.at(face, finer.position(t[i]));
  }
  return GuideMap(finer, corners);
}

FrameFieldOptions field_options(const WorkingSurface& surface, const Wishes& wishes, const RemeshOptions& options) {
  FrameFieldOptions field;
  field.curvature_alignment = std::pow(1 - options.field_smoothness, 3);
  if (options.anisotropy > 1) field.curvature_alignment = std::max(field.curvature_alignment, 1.0);
  if (!wishes.density.empty()) field.turn_for_lengths = std::min(1.0, 2 * options.size_fidelity);
  // Lengths that vary need cones where the curvature is, to the vertex.
  constexpr double kLeastSpread = 0.5;
  field.curvature_spread = std::max(kLeastSpread, 2 * options.field_smoothness * (1 - field.turn_for_lengths));
  if (wishes.guides.empty()) return field;
  const std::vector<Place> places = places_of(surface, *wishes.index);
  field.guides.assign(surface.mesh.face_count(), Vector3::Zero());
  for (int f = 0; f < surface.mesh.face_count(); ++f)
    if (places[f].face >= 0) field.guides[f] = wishes.guides.at(places[f].face, places[f].position);
  return field;
}

std::vector<double> direction_weights(const FrameFieldOptions& field) {
  constexpr double kGuided = 1;  // more makes grids that fit nowhere else; the smoothing turns edges the rest of the way
  std::vector<double> weights;
  for (const Vector3& guide : field.guides) weights.push_back(1 + kGuided * guide.squaredNorm());
  return weights;
}

std::vector<Eigen::Matrix3d> stretch_of(const WorkingSurface& surface, const FrameField& unit_frames, const Wishes& wishes,
                                        const RemeshOptions& options, const ThinStretch& thin_stretch) {
  std::vector<Eigen::Matrix3d> stretch;
  if (wishes.corner_frames.empty() && !(options.anisotropy > 1) && !thin_stretch.is_any()) return stretch;
  const int faces = surface.mesh.face_count();
  stretch.assign(faces, Eigen::Matrix3d::Zero());
  if (!wishes.corner_frames.empty()) {
    const std::vector<Place> places = places_of(surface, *wishes.index);
    for (int f = 0; f < faces; ++f) {
      const Plane plane = plane_of(face_basis(surface.mesh, f));
      Eigen::Matrix2d mean = Eigen::Matrix2d::Zero();
      for (int i = 0; i < 3 && places[f].face >= 0; ++i)
        mean += places[f].weight[i] * squared_stretch(in_plane(wishes.corner_frames[3 * places[f].face + i], plane));
      const double area = std::sqrt(mean.determinant());
      mean = area > 0 ? Eigen::Matrix2d(mean / area) : Eigen::Matrix2d::Identity();
      stretch[f] = plane * root_of(mean) * plane.transpose();
    }
    return stretch;
  }
  const std::vector<PrincipalCurvature> curvature = principal_curvatures(surface);
  if (thin_stretch.is_any()) {
    for (int f = 0; f < faces; ++f)
      stretch[f] =
          stretch_along_tube(curvature[f], thin_stretch.ratio(surface.target_length[f]), unit_frames.du[f], unit_frames.dv[f]);
    return stretch;
  }
  for (int f = 0; f < faces; ++f)
    stretch[f] = stretch_along_curvature(curvature[f], surface.target_length[f], options.anisotropy, unit_frames.du[f],
                                         unit_frames.dv[f]);
  return stretch;
}

}  // namespace hybrid_quad
