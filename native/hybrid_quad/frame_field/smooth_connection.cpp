#include "hybrid_quad/frame_field/smooth_connection.h"

#include <algorithm>

#include "hybrid_quad/frame_field/averaging_steps.h"

namespace hybrid_quad {

namespace {

constexpr double kTwoPi = 6.28318530717958648;

/// What vertices hold, and what may flow between them.
struct Curvature {
  std::vector<double> defect;   ///< #V: the angle that is missing to a full turn
  std::vector<double> area;     ///< #V: in squared quad edges; 0 where nothing flows
  std::vector<int> neighbours;  ///< #V

  bool flows(int a, int b) const { return area[a] > 0 && area[b] > 0; }
  /// From a to b in one step: a vertex gives away half of what it has at most, so that no step overshoots.
  double flow(int a, int b) const {
    const double conductance = 0.5 * std::min(area[a] / neighbours[a], area[b] / neighbours[b]);
    return conductance * (defect[a] / area[a] - defect[b] / area[b]);
  }
};

constexpr double kStep = 0.5;  // standard deviation of a step between even triangles, in their edges: half stays, half goes one edge

Curvature curvature_of(const WorkingSurface& surface, const FaceAngles& angles) {
  const TriangleMesh& mesh = surface.mesh;
  Curvature c;
  c.defect.assign(mesh.vertex_count(), kTwoPi);
  c.area.assign(mesh.vertex_count(), 0);
  c.neighbours.assign(mesh.vertex_count(), 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int v = mesh.from(h);
    const double length = surface.target_length[h / 3];
    c.defect[v] -= angles.corner(h);
    c.area[v] += mesh.area(h / 3) / (3 * length * length);
    ++c.neighbours[v];
  }
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (surface.features.on_feature[v] || mesh.outgoing(v) < 0 || mesh.is_boundary_vertex(v)) c.area[v] = 0;
  return c;
}

}  // namespace

std::vector<double> turns_for_average_curvature(const WorkingSurface& surface, const FaceAngles& angles, double spread) {
  const TriangleMesh& mesh = surface.mesh;
  Curvature curvature = curvature_of(surface, angles);
  std::vector<double> turns(mesh.halfedge_count(), 0), flow(mesh.halfedge_count(), 0);
  for (int step = averaging_steps(surface, spread, kStep); step > 0; --step) {
    for (int h = 0; h < mesh.halfedge_count(); ++h) {
      const int a = mesh.from(h), b = mesh.to(h);
      flow[h] = mesh.opposite(h) > h && curvature.flows(a, b) ? curvature.flow(a, b) : 0;
    }
    for (int h = 0; h < mesh.halfedge_count(); ++h) {
      if (flow[h] == 0) continue;
      curvature.defect[mesh.from(h)] -= flow[h];
      curvature.defect[mesh.to(h)] += flow[h];
      turns[h] += flow[h];
      turns[mesh.opposite(h)] -= flow[h];
    }
  }
  return turns;
}

}  // namespace hybrid_quad
