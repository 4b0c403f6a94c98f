#include "hybrid_quad/pipeline/limit_fit.h"

#include <algorithm>

#include "hybrid_quad/mesh/segment_index.h"

namespace hybrid_quad {

namespace {

using Segments = std::vector<std::array<Vector3, 2>>;

/// The feature curves of a component and of its mirror images, numbered as mirror_quads() does.
std::vector<SegmentIndex> curve_targets(const FeatureGraph& features, const TriangleMesh& mesh, PlaneSet planes) {
  std::vector<Segments> curves;
  for (const FeatureCurve& curve : features.curves) {
    Segments& segments = curves.emplace_back();
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
      segments.push_back({mesh.position(curve.vertices[i]), mesh.position(curve.vertices[i + 1])});
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!has_plane(planes, axis)) continue;
    for (std::size_t c = 0, count = curves.size(); c < count; ++c) {
      Segments image = curves[c];
      for (auto& segment : image)
        for (Vector3& p : segment) p[axis] = -p[axis];
      curves.push_back(std::move(image));
    }
  }
  std::vector<SegmentIndex> targets;
  targets.reserve(curves.size());
  for (Segments& segments : curves) targets.emplace_back(std::move(segments));
  return targets;
}

}  // namespace

LimitFitReport fit_component(ComponentResult& component, const QuadMesh& quads, const TriangleMesh& mesh, PlaneSet planes,
                             const SurfaceIndex& whole, const RunContext& context) {
  QuadMesh fitted = quads;
  const LimitFitReport report = fit_limit_surface(fitted, whole, curve_targets(component.features, mesh, planes), context);
  std::vector<Vector3>& own = component.mesh.positions;
  for (std::size_t v = 0; v < own.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      if (!has_plane(planes, axis) || own[v][axis] != 0) own[v][axis] = fitted.positions[v][axis];
  keep_clear_of_planes(component.mesh, planes);
  return report;
}

void add_fit(LimitFitRecord& record, const LimitFitReport& report, double share, double diagonal) {
  const double percent = 100 / diagonal;
  record.is_fitted = true;
  record.before.mean += share * percent * report.before.mean;
  record.after.mean += share * percent * report.after.mean;
  record.before.largest = std::max(record.before.largest, percent * report.before.largest);
  record.after.largest = std::max(record.after.largest, percent * report.after.largest);
  record.held_back += report.held_back;
}

}  // namespace hybrid_quad
