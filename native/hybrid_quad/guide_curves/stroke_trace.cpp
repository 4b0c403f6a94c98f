#include <algorithm>
#include <cmath>

#include "hybrid_quad/guide_curves/guide_curves.h"

namespace hybrid_quad {

namespace {

constexpr double kSpacing = 0.1;        ///< of samples, in edge lengths
constexpr int kMostSamples = 20000;
constexpr double kClosingGap = 0.5;     ///< in edge lengths
constexpr double kLeastLoop = 3;        ///< in edge lengths: shorter strokes are not closed
constexpr double kReach = 2, kReachOfAll = 0.05;  ///< how far a stroke may be from the surface, in edge lengths or of its diagonal
constexpr double kBeyond = 1e-3;        ///< in edge lengths: farther from the boundary than that is off the surface

struct Sample {
  Vector3 position;
  double reach;  ///< how far the surface may be
};

bool is_closed(const std::vector<Vector3>& points, double total, double length) {
  if (points.size() < 3) return false;
  const double gap = (points.front() - points.back()).norm();
  return gap == 0 || (gap < kClosingGap * length && total > kLeastLoop * length);
}

/// Evenly along every segment, its ends included.
std::vector<Sample> samples_of(const std::vector<Vector3>& points, double spacing, double least_reach) {
  constexpr double kPartOfSegment = 0.5;
  std::vector<Sample> samples;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector3 along = points[i + 1] - points[i];
    const double reach = std::max(least_reach, kPartOfSegment * along.norm());
    const int count = std::max(1, static_cast<int>(std::ceil(along.norm() / spacing)));
    for (int k = samples.empty() ? 0 : 1; k <= count; ++k)
      samples.push_back({points[i] + (static_cast<double>(k) / count) * along, reach});
  }
  return samples;
}

bool is_on_boundary(const TriangleMesh& mesh, const SurfacePoint& p) {
  constexpr double kTouches = 1e-6;
  for (int h = 3 * p.face; h < 3 * p.face + 3; ++h) {
    if (!mesh.is_boundary(h)) continue;
    const Vector3 edge = mesh.edge_vector(h), to = p.position - mesh.position(mesh.from(h));
    if (edge.cross(to).norm() <= kTouches * edge.squaredNorm()) return true;
  }
  return false;
}

}  // namespace

StrokeTrace trace_stroke(const GuideStroke& stroke, const SurfaceIndex& surface, double length) {
  StrokeTrace trace;
  std::vector<Vector3> points = stroke.points;
  double total = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) total += (points[i + 1] - points[i]).norm();
  if (!(total > 0)) return trace;
  const bool closed = is_closed(points, total, length);
  if (closed && points.front() != points.back()) points.push_back(points.front());
  const std::vector<Sample> samples = samples_of(points, std::max(kSpacing * length, total / kMostSamples),
                                                 std::max(kReach * length, kReachOfAll * surface.mesh().diagonal()));
  bool in_run = false;
  for (const Sample& sample : samples) {
    const SurfacePoint p = surface.nearest(sample.position);
    const double distance = std::sqrt(p.squared_distance);
    const bool is_off = distance > sample.reach || (distance > kBeyond * length && is_on_boundary(surface.mesh(), p));
    if (is_off) {
      // A stroke that leaves an open surface goes on to the boundary.
      if (in_run && distance <= sample.reach) trace.runs.back().samples.push_back(p);
      trace.is_cut |= distance > sample.reach;
      in_run = false;
      continue;
    }
    if (!in_run) trace.runs.emplace_back();
    in_run = true;
    std::vector<SurfacePoint>& run = trace.runs.back().samples;
    if (run.empty() || run.back().position != p.position) run.push_back(p);
  }
  if (closed && trace.runs.size() == 1 && trace.runs[0].samples.size() > 2 && in_run &&
      trace.runs[0].samples.front().position == trace.runs[0].samples.back().position)
    trace.runs[0].closed = true;
  const auto is_point = [](const StrokeTrace::Run& run) { return run.samples.size() < 2; };
  trace.runs.erase(std::remove_if(trace.runs.begin(), trace.runs.end(), is_point), trace.runs.end());
  return trace;
}

}  // namespace hybrid_quad
