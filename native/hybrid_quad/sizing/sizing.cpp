#include "hybrid_quad/sizing/sizing.h"

#include <cmath>

#include "hybrid_quad/sizing/conformal_scale.h"
#include "hybrid_quad/sizing/curl_correction.h"

namespace hybrid_quad {

namespace {

/// Rows of unit frames become rows that measure in quads.
void scale_to_target(const WorkingSurface& surface, const std::vector<double>& length_factor, FrameField& field) {
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    const double length = surface.target_length[f] * (length_factor.empty() ? 1.0 : length_factor[f]);
    field.du[f] /= length;
    field.dv[f] /= length;
  }
}

/// Puts X (du, dv) in place of (du, dv) where that is a frame, and counts where it is not.
void apply_correction(const TriangleMesh& mesh, const std::vector<std::array<double, 4>>& x, SizedFrames& sized) {
  constexpr double kLeastDeterminant = 0.2, kMostStretch = 4;
  double deviation = 0, total = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto& m = x[f];
    const double determinant = m[0] * m[3] - m[1] * m[2];
    const double norm = std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3]);
    if (!(determinant > kLeastDeterminant) || !(norm < kMostStretch)) {
      ++sized.flipped_faces;
      continue;
    }
    const Vector3 du = sized.field.du[f], dv = sized.field.dv[f];
    sized.field.du[f] = m[0] * du + m[1] * dv;
    sized.field.dv[f] = m[2] * du + m[3] * dv;
    const double area = mesh.area(f);
    total += area;
    deviation += area * ((m[0] - 1) * (m[0] - 1) + m[1] * m[1] + m[2] * m[2] + (m[3] - 1) * (m[3] - 1));
  }
  sized.mean_correction = total > 0 ? std::sqrt(deviation / total) : 0;
}

double area_in_quads(const TriangleMesh& mesh, const FrameField& field) {
  double sum = 0;
  for (int f = 0; f < mesh.face_count(); ++f)
    sum += 0.5 * mesh.area_normal(f).norm() * field.du[f].cross(field.dv[f]).dot(mesh.normal(f));
  return sum;
}

double asked_quads(const WorkingSurface& surface) {
  double sum = 0;
  for (int f = 0; f < surface.mesh.face_count(); ++f)
    sum += surface.mesh.area(f) / (surface.target_length[f] * surface.target_length[f]);
  return sum;
}

}  // namespace

SizedFrames apply_sizing(const WorkingSurface& surface, const FrameField& unit_frames, double quads_asked,
                         const SizingOptions& options, const RunContext& context) {
  const TriangleMesh& mesh = surface.mesh;
  SizedFrames sized;
  sized.field = unit_frames;
  context.checkpoint(0);
  std::vector<double> length_factor;
  if (options.conformal)
    length_factor = conformal_length_factor(surface, unit_frames, options.conformal_clip, context);
  scale_to_target(surface, length_factor, sized.field);
  if (options.correct_curl) {
    const auto x = curl_correction(surface, sized.field, {options.curl_weight, options.feature_weight}, context);
    apply_correction(mesh, x, sized);
  }
  const double quads = quads_asked > 0 ? quads_asked : asked_quads(surface);
  const double scale = std::sqrt(quads / area_in_quads(mesh, sized.field));
  if (std::isfinite(scale) && scale > 0)
    for (int f = 0; f < mesh.face_count(); ++f) {
      sized.field.du[f] *= scale;
      sized.field.dv[f] *= scale;
    }
  context.checkpoint(1);
  return sized;
}

}  // namespace hybrid_quad
