#include "hybrid_quad/periodic_field/grid_measure.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/periodic_field/narrow_strips.h"

namespace hybrid_quad {

namespace {

/// The grid direction that a feature edge, known by the higher of its half-edges, is nearer to.
void choose_axis(const TriangleMesh& mesh, const FrameField& frames, int h, GridMeasure& measure) {
  const Vector2 mean = measure.average(mesh, frames, h);
  const int axis = std::abs(mean[0]) >= std::abs(mean[1]) ? 0 : 1;
  measure.axis[h] = static_cast<std::int8_t>(axis);
  const int o = mesh.opposite(h);
  if (o >= 0) measure.axis[o] = static_cast<std::int8_t>(axis ^ (frames.matching[h] & 1));
}

/// Lays a feature edge on its grid direction.
void align_feature_edge(const TriangleMesh& mesh, const FrameField& frames, int h, GridMeasure& measure) {
  const Vector2 mean = measure.average(mesh, frames, h);
  const int axis = measure.axis[h];
  Vector2 laid(0, 0);
  laid[axis] = std::copysign(mean.norm(), mean[axis]);
  measure.along[h] = laid;
  const int o = mesh.opposite(h);
  if (o >= 0) measure.along[o] = -turned(laid, frames.matching[h]);
}

/// The fewest quad edges that a curve may get: a closed chain of fewer than four is no boundary of quads.
double fewest_edges(const FeatureCurve& curve) {
  const bool returns =
      curve.closed || (!curve.vertices.empty() && curve.vertices.front() == curve.vertices.back());
  return returns ? 4.0 : 1.0;
}

/// Curves too short for the edges that they need, and those that are to get a certain number.
void stretch_curves(const TriangleMesh& mesh, const FeatureGraph& features, GridMeasure& measure) {
  std::vector<double> length(features.curves.size(), 0.0);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (measure.axis[h] >= 0 && h > mesh.opposite(h))
      length[features.halfedge_curve[h]] += measure.along[h].norm();
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (measure.axis[h] < 0) continue;
    const int curve = features.halfedge_curve[h];
    const int asked = features.curves[curve].asked_count;
    const double count = asked > 0 ? asked : std::max(length[curve], fewest_edges(features.curves[curve]));
    if (length[curve] > 0 && length[curve] != count) measure.along[h] *= count / length[curve];
  }
}

}  // namespace

GridMeasure measure_edges(const WorkingSurface& surface, const FrameField& frames, int strip_rows) {
  const TriangleMesh& mesh = surface.mesh;
  GridMeasure measure;
  measure.along.resize(mesh.halfedge_count());
  measure.axis.assign(mesh.halfedge_count(), -1);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    measure.along[h] = frames.grid_vector(mesh, h);
    if (!measure.along[h].allFinite()) measure.along[h].setZero();
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (surface.features.is_feature(h) && h > mesh.opposite(h)) choose_axis(mesh, frames, h, measure);
  widen_narrow_strips(mesh, frames, strip_rows, measure);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (measure.axis[h] >= 0 && h > mesh.opposite(h)) align_feature_edge(mesh, frames, h, measure);
  stretch_curves(mesh, surface.features, measure);
  return measure;
}

VertexGauges choose_vertex_gauges(const TriangleMesh& mesh, const FrameField& frames) {
  VertexGauges gauges;
  gauges.corner_turn.assign(mesh.halfedge_count(), 0);
  gauges.holonomy.assign(mesh.vertex_count(), 0);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int start = mesh.outgoing(v);
    if (start < 0) continue;
    int turn = 0;
    for (int h = start;;) {
      gauges.corner_turn[h] = static_cast<std::uint8_t>(turn);
      const int next = mesh.rotate_ccw(h);
      if (next < 0) break;
      turn = wrap_turns(turn + frames.matching[TriangleMesh::previous(h)]);
      h = next;
      if (h == start) {
        gauges.holonomy[v] = static_cast<std::uint8_t>(turn);
        break;
      }
    }
  }
  return gauges;
}

}  // namespace hybrid_quad
