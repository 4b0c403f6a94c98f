#include "hybrid_quad/frame_field/soft_alignment.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/frame_field/face_angles.h"
#include "hybrid_quad/frame_field/surface_curvature.h"

namespace hybrid_quad {

namespace {

using Complex = std::complex<double>;

/// weight e^{4 i angle} of a direction in face f.
Complex pull_along(const FaceBasis& basis, const Vector3& direction, double weight) {
  const double x = direction.dot(basis.along), y = direction.dot(basis.across);
  return x == 0 && y == 0 ? Complex(0, 0) : std::polar(weight, 4 * std::atan2(y, x));
}

void add_guides(const WorkingSurface& surface, const std::vector<Vector3>& guides, std::vector<Complex>& pulls) {
  constexpr double kFullStrength = 12;
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    const double strength = std::min(1.0, guides[f].norm());
    if (strength > 0) pulls[f] += pull_along(face_basis(surface.mesh, f), guides[f], kFullStrength * strength * strength);
  }
}

/// Along the principal directions, the more the surface bends one way only; not where a guide says otherwise.
void add_curvature(const WorkingSurface& surface, double alignment, const std::vector<Vector3>& guides, const RunContext& context,
                   std::vector<Complex>& pulls) {
  constexpr double kMostPull = 4.8;
  constexpr double kClear = 0.5;  // a tube of radius 2 h: its direction could not be clearer
  const std::vector<PrincipalCurvature> curvature = principal_curvatures(surface, context);
  parallel_chunks(surface.mesh.face_count(), context, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) {
      const double clear = std::min(1.0, curvature[f].anisotropy(surface.target_length[f]) / kClear);
      const double free = guides.empty() ? 1 : std::max(0.0, 1 - guides[f].norm());
      pulls[f] += pull_along(face_basis(surface.mesh, f), curvature[f].direction, kMostPull * alignment * free * clear * clear);
    }
  });
}

}  // namespace

std::vector<Complex> soft_pulls(const WorkingSurface& surface, const FrameFieldOptions& options, const RunContext& context) {
  std::vector<Complex> pulls;
  if (options.guides.empty() && !(options.curvature_alignment > 0)) return pulls;
  pulls.assign(surface.mesh.face_count(), Complex(0, 0));
  if (options.curvature_alignment > 0) add_curvature(surface, options.curvature_alignment, options.guides, context, pulls);
  if (!options.guides.empty()) add_guides(surface, options.guides, pulls);
  return pulls;
}

std::vector<double> turns_for_lengths(const WorkingSurface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<double> log_length(mesh.vertex_count(), 0), share(mesh.vertex_count(), 0), turns(mesh.halfedge_count(), 0);
  for (int f = 0; f < mesh.face_count(); ++f)
    for (const int v : mesh.face(f)) {
      log_length[v] += std::log(surface.target_length[f]);
      share[v] += 1;
    }
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (share[v] > 0) log_length[v] /= share[v];
  const auto cotangent = [&](int h) {
    const Vector3 a = mesh.edge_vector(TriangleMesh::previous(h)), b = -mesh.edge_vector(TriangleMesh::next(h));
    const double sine = a.cross(b).norm();
    return sine > 0 ? std::clamp(a.dot(b) / sine, -10.0, 10.0) : 0.0;
  };
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o < h || surface.features.is_feature(h)) continue;
    turns[h] = 0.5 * (cotangent(h) + cotangent(o)) * (log_length[mesh.from(h)] - log_length[mesh.to(h)]);
    turns[o] = -turns[h];
  }
  return turns;
}

}  // namespace hybrid_quad
