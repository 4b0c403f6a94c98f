#include "hybrid_quad/sizing/chord_lengths.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/frame_field/surface_curvature.h"
#include "hybrid_quad/sizing/feature_size.h"

namespace hybrid_quad {

namespace {

double length_for(const PrincipalCurvature& curvature, const ChordOptions& options) {
  constexpr double kAim = 0.9;  // of the error: lengths come out uneven
  const double bend = std::max(std::abs(curvature.strong), std::abs(curvature.strong + curvature.weak));
  const double height = kAim * options.error, least_bend = 8 * height / (options.longest * options.longest);
  return bend > least_bend ? std::max(options.least, std::sqrt(8 * height / bend)) : options.longest;
}

/// Every face gets the least of itself and its neighbours: a quad must fit all of the surface that it covers.
void spread_least(const TriangleMesh& mesh, std::vector<double>& value) {
  const std::vector<double> before = value;
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.opposite(h) >= 0) value[h / 3] = std::min(value[h / 3], before[mesh.opposite(h) / 3]);
}

}  // namespace

std::vector<double> chord_lengths(const TriangleMesh& mesh, const FeatureGraph& features, const ChordOptions& options,
                                  const RunContext& context) {
  constexpr int kRounds = 2;
  constexpr double kPart = 0.4;  // of the lengths: over more than half a quad, bends would be averaged out
  constexpr int kSpread = 4;     // of such faces, half a quad
  constexpr double kGrowth = 0.4;
  std::vector<double> length(mesh.vertex_count(), std::clamp(options.start, options.least, options.longest));
  for (int round = 0; round < kRounds; ++round) {
    context.checkpoint();
    for (double& l : length) l *= kPart;
    const WorkingSurface surface = build_working_surface(mesh, features, length, WorkingSurfaceOptions{}, context);
    std::vector<double> asked;
    for (const PrincipalCurvature& curvature : principal_curvatures(surface)) asked.push_back(length_for(curvature, options));
    for (int step = 0; step < kSpread; ++step) spread_least(surface.mesh, asked);
    const SurfaceIndex index(surface.mesh, {});
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const int face = index.nearest(mesh.position(v)).face;
      length[v] = face >= 0 ? asked[face] : options.longest;
    }
    grade_lengths(mesh, options.longest, length, kGrowth, context);
  }
  return length;
}

}  // namespace hybrid_quad
