#include "hybrid_quad/periodic_field/periodic_field.h"

#include <cmath>
#include <string>

#include "hybrid_quad/periodic_field/gauss_newton_phases.h"
#include "hybrid_quad/periodic_field/grid_measure.h"
#include "hybrid_quad/periodic_field/multilevel_phases.h"
#include "hybrid_quad/periodic_field/phase_graph.h"

namespace hybrid_quad {

namespace {

/// The directions, in a vertex's gauge, in which features leave it.
struct Departures {
  int edges = 0;
  int mask = 0;  ///< bits 0..3: +u, +v, -u, -v
};

int direction_bit(const Vector2& d) {
  if (std::abs(d[0]) >= std::abs(d[1])) return d[0] >= 0 ? 1 : 4;
  return d[1] >= 0 ? 2 : 8;
}

std::vector<Departures> feature_departures(const TriangleMesh& mesh, const GridMeasure& measure,
                                           const std::vector<std::uint8_t>& corner_turn) {
  std::vector<Departures> departures(mesh.vertex_count());
  const auto add = [&](int v, const Vector2& d) {
    ++departures[v].edges;
    departures[v].mask |= direction_bit(d);
  };
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (measure.axis[h] < 0 || h < mesh.opposite(h)) continue;
    add(mesh.from(h), turned(measure.along[h], inverse_turns(corner_turn[h])));
    add(mesh.to(h), turned(Vector2(-measure.along[h]), inverse_turns(corner_turn[TriangleMesh::next(h)])));
  }
  return departures;
}

/// A feature vertex is on one isoline only if its curve passes straight on in the grid; else both coordinates
/// are integers.
std::vector<GridConstraint> grid_constraints(const WorkingSurface& surface, const GridMeasure& measure,
                                             const VertexGauges& gauges) {
  const std::vector<Departures> departures = feature_departures(surface.mesh, measure, gauges.corner_turn);
  std::vector<GridConstraint> constraint(surface.mesh.vertex_count(), GridConstraint::kFree);
  for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
    if (surface.features.is_corner[v]) {
      constraint[v] = GridConstraint::kCorner;
    } else if (departures[v].edges > 0) {
      const bool plain = departures[v].edges == 2 && gauges.holonomy[v] == 0;
      constraint[v] = plain && departures[v].mask == 5    ? GridConstraint::kIsolineV
                      : plain && departures[v].mask == 10 ? GridConstraint::kIsolineU
                                                          : GridConstraint::kCorner;
    }
  }
  return constraint;
}

}  // namespace

PeriodicField solve_periodic_field(const WorkingSurface& surface, const FrameField& frames,
                                   const PeriodicFieldOptions& options, const RunContext& context) {
  context.checkpoint(0);
  const GridMeasure measure = measure_edges(surface, frames, options.strip_rows);
  VertexGauges gauges = choose_vertex_gauges(surface.mesh, frames);
  PeriodicField field;
  field.constraint = grid_constraints(surface, measure, gauges);
  field.corner_turn = std::move(gauges.corner_turn);
  if (surface.mesh.vertex_count() == 0) return field;
  PhaseGraph graph =
      build_phase_graph(surface.mesh, measure, field.corner_turn, field.constraint, options.feature_weight);
  field.psi = options.solver == PeriodicSolver::kMultilevel
                  ? solve_multilevel_phases(graph, options, context)
                  : solve_gauss_newton_phases(graph, options, context);
  field.energy = phase_energy(graph, field.psi);
  context.checkpoint(1);
  return field;
}

std::vector<std::string> violations_of(const PeriodicField& field, const WorkingSurface& surface,
                                       const FrameField& frames) {
  std::vector<std::string> found;
  const TriangleMesh& mesh = surface.mesh;
  const std::size_t vertices = mesh.vertex_count();
  if (field.psi.size() != vertices || field.constraint.size() != vertices ||
      field.corner_turn.size() != static_cast<std::size_t>(mesh.halfedge_count())) {
    found.push_back("array sizes");
    return found;
  }
  if (!std::isfinite(field.energy) || field.energy < 0)
    found.push_back("energy is no finite positive number");
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const PhasePair& z = field.psi[v];
    const std::string at = " at vertex " + std::to_string(v);
    if (!(std::abs(std::abs(z.a) - 1) < 1e-9) || !(std::abs(std::abs(z.b) - 1) < 1e-9))
      found.push_back("phase not of length one" + at);
    const GridConstraint c = field.constraint[v];
    if (c == GridConstraint::kIsolineV && z.b != z.a) found.push_back("v is no integer" + at);
    if (c == GridConstraint::kIsolineU && z.b != std::conj(z.a)) found.push_back("u is no integer" + at);
    if (c == GridConstraint::kCorner && (z.a != z.b || std::abs(z.a.real()) != 1 || z.a.imag() != 0))
      found.push_back("corner is off the grid" + at);
    if (surface.features.is_corner[v] && c != GridConstraint::kCorner)
      found.push_back("corner is not pinned" + at);
    if (surface.features.on_feature[v] && c == GridConstraint::kFree)
      found.push_back("feature vertex is free" + at);
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int next = mesh.rotate_ccw(h);
    if (next < 0 || next == mesh.outgoing(mesh.from(h))) continue;
    if (field.corner_turn[next] !=
        wrap_turns(field.corner_turn[h] + frames.matching[TriangleMesh::previous(h)]))
      found.push_back("corner turns disagree with the matching at half-edge " + std::to_string(h));
  }
  return found;
}

}  // namespace hybrid_quad
