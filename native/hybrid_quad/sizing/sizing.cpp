#include "hybrid_quad/sizing/sizing.h"

#include <cmath>

#include "hybrid_quad/sizing/conformal_scale.h"
#include "hybrid_quad/sizing/curl_correction.h"
#include "hybrid_quad/sizing/curve_count_scale.h"

namespace hybrid_quad {

namespace {

/// Rows of unit frames become rows that measure in quads: edges F = stretch * axes * length, rows F^-1.
void scale_to_target(const WorkingSurface& surface, const std::vector<double>& length_factor,
                     const std::vector<Eigen::Matrix3d>& stretch, FrameField& field) {
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    const double length = surface.target_length[f] * (length_factor.empty() ? 1.0 : length_factor[f]);
    field.du[f] /= length;
    field.dv[f] /= length;
    if (stretch.empty()) continue;
    // Symmetric in the face's plane; adding the normal makes it invertible in space.
    const Vector3 normal = surface.mesh.normal(f);
    const Eigen::Matrix3d inverse = (stretch[f] + normal * normal.transpose()).inverse();
    field.du[f] = inverse * field.du[f];
    field.dv[f] = inverse * field.dv[f];
  }
}

double deviation_from_identity(const std::array<double, 4>& m) {
  return (m[0] - 1) * (m[0] - 1) + m[1] * m[1] + m[2] * m[2] + (m[3] - 1) * (m[3] - 1);
}

/// As much of an unsound correction as leaves it sound.
std::array<double, 4> moderated(const std::array<double, 4>& m) {
  constexpr int kHalvings = 4;
  double share = 1;
  for (int step = 0; step < kHalvings; ++step) {
    share /= 2;
    const std::array<double, 4> part{1 + share * (m[0] - 1), share * m[1], share * m[2], 1 + share * (m[3] - 1)};
    if (is_sound_correction(part)) return part;
  }
  return {1, 0, 0, 1};
}

/// Puts X (du, dv) in place of (du, dv), moderated and counted where that is no frame.
void apply_correction(const TriangleMesh& mesh, const std::vector<std::array<double, 4>>& x, SizedFrames& sized) {
  double deviation = 0, total = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    std::array<double, 4> m = x[f];
    if (!is_sound_correction(m)) {
      ++sized.flipped_faces;
      m = moderated(m);
    }
    const Vector3 du = sized.field.du[f], dv = sized.field.dv[f];
    sized.field.du[f] = m[0] * du + m[1] * dv;
    sized.field.dv[f] = m[2] * du + m[3] * dv;
    const double area = mesh.area(f);
    total += area;
    deviation += area * deviation_from_identity(m);
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
  scale_to_target(surface, length_factor, options.stretch, sized.field);
  const double quads = quads_asked > 0 ? quads_asked : asked_quads(surface);
  const CurveCountScale counts(surface);
  if (!counts.is_idle()) {
    scale_to_quads(mesh, quads, sized.field);
    counts.apply(sized.field, context);
  }
  if (options.correct_curl) {
    CurlCorrectionOptions correction;
    correction.curl_weight = options.curl_weight;
    correction.feature_weight = options.feature_weight;
    correction.direction_weight = options.direction_weight;
    const auto x = curl_correction(surface, sized.field, correction, context);
    apply_correction(mesh, x, sized);
  }
  scale_to_quads(mesh, quads, sized.field);
  counts.apply(sized.field, context);
  context.checkpoint(1);
  return sized;
}

bool quads_only_scale(const WorkingSurface& surface) { return CurveCountScale(surface).is_idle(); }

void scale_to_quads(const TriangleMesh& mesh, double quads, FrameField& field) {
  const double scale = std::sqrt(quads / area_in_quads(mesh, field));
  if (!std::isfinite(scale) || !(scale > 0)) return;
  for (int f = 0; f < mesh.face_count(); ++f) {
    field.du[f] *= scale;
    field.dv[f] *= scale;
  }
}

}  // namespace hybrid_quad
