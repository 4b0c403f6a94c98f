#include "hybrid_quad/spanning_parameterization/lifted_grid.h"

#include <cmath>
#include <cstdlib>

#include "hybrid_quad/periodic_field/phase_graph.h"
#include "hybrid_quad/spanning_parameterization/curve_counts.h"

namespace hybrid_quad {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kSweepPairsAroundCones = 5;  // forwards and backwards
constexpr double kFeatureWeight = 20;

std::vector<PhasePair> pin_cones(const WorkingSurface& surface, const FrameField& frames,
                                 const PeriodicField& field, const GridMeasure& measure, LiftedGrid& grid) {
  std::vector<PhasePair> psi = field.psi;
  bool any = false;
  for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
    if (grid.constraint[v] != GridConstraint::kFree) continue;
    if (grid.holonomy[v] == 0 && frames.cone_index[v] == 0) continue;
    grid.constraint[v] = GridConstraint::kCorner;
    psi[v] = projected(psi[v], GridConstraint::kCorner);
    any = true;
  }
  const CornerSigns signs = corner_signs(surface.features, psi);
  if (any || !signs.vertex.empty()) {
    const PhaseGraph graph =
        build_phase_graph(surface.mesh, measure, field.corner_turn, grid.constraint, kFeatureWeight);
    for (int pair = 0; pair < kSweepPairsAroundCones; ++pair) {
      impose(signs, psi);
      relax(graph, 2, psi);
    }
    impose(signs, psi);
  }
  return psi;
}

Vector2 grid_value(const PhasePair& z, GridConstraint constraint) {
  const double alpha = std::arg(z.a), beta = std::arg(z.b);
  switch (constraint) {
    case GridConstraint::kIsolineV:
      return {alpha / kPi, 0.0};
    case GridConstraint::kIsolineU:
      return {0.0, alpha / kPi};
    case GridConstraint::kCorner:
      return {z.a.real() >= 0 ? 0.0 : 1.0, 0.0};
    default:
      return {(alpha + beta) / (2 * kPi), (alpha - beta) / (2 * kPi)};
  }
}

/// The vector of D2 nearest to x in the phases' coordinates.
IntVector2 nearest_jump(const Vector2& x) {
  return burgers_of({rounded(0.5 * (x[0] + x[1])), rounded(0.5 * (x[0] - x[1]))});
}

void choose_jumps(const TriangleMesh& mesh, const FrameField& frames, const GridMeasure& measure,
                  LiftedGrid& grid) {
  grid.jump.assign(mesh.halfedge_count(), IntVector2{0, 0});
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (h < mesh.opposite(h)) continue;
    const Vector2 missing = measure.average(mesh, frames, h) - grid.across_half_edge(mesh, h);
    IntVector2 jump = nearest_jump(missing);
    if (measure.axis[h] >= 0) {
      const int along = measure.axis[h], across = 1 - along;
      jump[across] = -rounded(grid.across_half_edge(mesh, h)[across]);
      jump[along] = jump[across] + 2 * rounded(0.5 * (missing[along] - jump[across]));
    }
    set_jump(mesh, frames, h, jump, grid);
  }
}

}  // namespace

void set_jump(const TriangleMesh& mesh, const FrameField& frames, int h, const IntVector2& jump,
              LiftedGrid& grid) {
  grid.jump[h] = jump;
  const int o = mesh.opposite(h);
  if (o < 0) return;
  const Vector2 there = -turned(grid.across_half_edge(mesh, h), frames.matching[h]);
  grid.jump[o] = {0, 0};
  const Vector2 rest = there - grid.across_half_edge(mesh, o);
  grid.jump[o] = {rounded(rest[0]), rounded(rest[1])};
}

int unit_count(const IntVector2& burgers) { return std::max(std::abs(burgers[0]), std::abs(burgers[1])); }

int fewest_curve_edges(const FeatureCurve& curve) {
  const bool returns =
      curve.closed || (!curve.vertices.empty() && curve.vertices.front() == curve.vertices.back());
  return returns ? 4 : 1;
}

LiftedGrid lift(const WorkingSurface& surface, const FrameField& frames, const PeriodicField& field,
                const GridMeasure& measure) {
  LiftedGrid grid;
  grid.constraint = field.constraint;
  grid.corner_turn = field.corner_turn;
  grid.holonomy = choose_vertex_gauges(surface.mesh, frames).holonomy;
  const std::vector<PhasePair> psi = pin_cones(surface, frames, field, measure, grid);
  grid.value.resize(surface.mesh.vertex_count());
  for (int v = 0; v < surface.mesh.vertex_count(); ++v)
    grid.value[v] = grid_value(psi[v], grid.constraint[v]);
  choose_jumps(surface.mesh, frames, measure, grid);
  settle_curve_counts(surface, frames, measure, grid);
  return grid;
}

}  // namespace hybrid_quad
