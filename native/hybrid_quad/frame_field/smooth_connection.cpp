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
};

/// An edge through which curvature flows.
struct Channel {
  int halfedge, from, to;
  double conductance;  ///< a vertex gives away half of what it has at most in a step, so that none overshoots
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

std::vector<Channel> channels_of(const TriangleMesh& mesh, const Curvature& c) {
  std::vector<Channel> channels;
  channels.reserve(mesh.halfedge_count() / 2);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.opposite(h) < h) continue;
    const int a = mesh.from(h), b = mesh.to(h);
    if (!(c.area[a] > 0 && c.area[b] > 0)) continue;
    channels.push_back({h, a, b, 0.5 * std::min(c.area[a] / c.neighbours[a], c.area[b] / c.neighbours[b])});
  }
  return channels;
}

}  // namespace

std::vector<double> turns_for_average_curvature(const WorkingSurface& surface, const FaceAngles& angles, double spread) {
  const TriangleMesh& mesh = surface.mesh;
  Curvature curvature = curvature_of(surface, angles);
  const std::vector<Channel> channels = channels_of(mesh, curvature);
  std::vector<double> flowed(channels.size(), 0), density(mesh.vertex_count(), 0), turns(mesh.halfedge_count(), 0);
  for (int step = averaging_steps(surface, spread, kStep); step > 0; --step) {
    for (int v = 0; v < mesh.vertex_count(); ++v)
      if (curvature.area[v] > 0) density[v] = curvature.defect[v] / curvature.area[v];
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const Channel& c = channels[i];
      const double flow = c.conductance * (density[c.from] - density[c.to]);
      if (flow == 0) continue;
      curvature.defect[c.from] -= flow;
      curvature.defect[c.to] += flow;
      flowed[i] += flow;
    }
  }
  for (std::size_t i = 0; i < channels.size(); ++i) {
    turns[channels[i].halfedge] += flowed[i];
    turns[mesh.opposite(channels[i].halfedge)] -= flowed[i];
  }
  return turns;
}

}  // namespace hybrid_quad
