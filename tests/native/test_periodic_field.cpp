#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_quad/periodic_field/periodic_field.h"
#include "hybrid_quad/periodic_field/phase_graph.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

PhasePair phases_at(double u, double v) {
  return {std::polar(1.0, M_PI * (u + v)), std::polar(1.0, M_PI * (u - v))};
}

void expect_near(const PhasePair& x, const PhasePair& y, double tolerance = 1e-12) {
  EXPECT_NEAR(std::abs(x.a - y.a), 0, tolerance);
  EXPECT_NEAR(std::abs(x.b - y.b), 0, tolerance);
}

double inner(const PhasePair& x, const PhasePair& y) {
  return (x.a * std::conj(y.a)).real() + (x.b * std::conj(y.b)).real();
}

PhasePair some_pair(int i) {
  return {std::polar(1 + 0.3 * std::sin(i), 1.7 * i), std::polar(1.2 + 0.1 * std::cos(3.0 * i), 0.9 * i)};
}
PhaseTransport some_transport(int i) { return {i & 3, some_pair(i + 5).a, some_pair(i + 9).b}; }

PeriodicField solved(const WorkingSurface& surface, const FrameField& frames,
                     PeriodicSolver solver = PeriodicSolver::kMultilevel) {
  PeriodicFieldOptions options;
  options.solver = solver;
  return solve_periodic_field(surface, frames, options, RunContext{});
}

void expect_valid(const PeriodicField& field, const WorkingSurface& surface, const FrameField& frames) {
  const auto found = violations_of(field, surface, frames);
  EXPECT_TRUE(found.empty()) << found.front();
}

TEST(QuarterTurn, PhasesTurnLikeCoordinates) {
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 8; ++i) {
      const Vector2 uv(0.37 * i - 1, 0.21 * i * i);
      const Vector2 t = turned(uv, k);
      expect_near(turned(phases_at(uv[0], uv[1]), k), phases_at(t[0], t[1]), 1e-10);
      expect_near(turned(turned(some_pair(i), k), inverse_turns(k)), some_pair(i));
    }
}

TEST(QuarterTurn, OddTranslationsFlipPhasesAndEvenOnesLeaveThem) {
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j) {
      const double sign = (i + j) % 2 == 0 ? 1 : -1;
      const PhasePair here = phases_at(0.3, -0.45), there = phases_at(0.3 + i, -0.45 + j);
      expect_near(there, {sign * here.a, sign * here.b}, 1e-12);
    }
}

TEST(PhaseTransport, ComposesAndHasAnAdjoint) {
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j) {
      const PhaseTransport s = some_transport(i), t = some_transport(j + 3);
      const PhasePair z = some_pair(i + 2 * j), w = some_pair(3 * i - j);
      expect_near(transported(composed(s, t), z), transported(s, transported(t, z)), 1e-10);
      EXPECT_NEAR(inner(w, transported(s, z)), inner(transported(adjoint(s), w), z), 1e-10);
    }
}

TEST(PhaseGraph, CoarseEnergyIsTheFineEnergyOfLiftedValues) {
  const WorkingSurface surface = test::surface_of(test::icosphere(3), 0.2);
  const FrameField frames = test::smooth_frames(surface, 0.2);
  const PeriodicField field = solved(surface, frames);
  const PhaseGraph fine = build_phase_graph(surface.mesh, measure_edges(surface, frames), field.corner_turn,
                                            field.constraint, 20);
  const PhaseAggregation step = coarsen(fine);
  std::vector<PhasePair> z(step.coarse.node_count()), lifted(fine.node_count());
  for (int i = 0; i < step.coarse.node_count(); ++i) z[i] = phases_at(0.3 * i, 0.7 * i);
  for (int i = 0; i < fine.node_count(); ++i)
    lifted[i] = transported(step.prolongation[i], z[step.aggregate[i]]);
  // Edges that fall inside an aggregate with a turn are dropped on the coarse level: there are few, at cones.
  EXPECT_NEAR(phase_energy(step.coarse, z), phase_energy(fine, lifted), 0.02 * phase_energy(fine, lifted));
}

TEST(PeriodicField, AlignedFlatGridHasNoEnergy) {
  const WorkingSurface surface = test::surface_of(test::flat_grid(20, 14, 5, 4), 1);
  const FrameField frames = test::constant_frames(surface, {1, 0, 0}, {0, 1, 0});
  const PeriodicField field = solved(surface, frames);
  expect_valid(field, surface, frames);
  EXPECT_LT(field.energy, 1e-5);
}

TEST(PeriodicField, EvenTorusHasNoEnergyAndOddOneHas) {
  const WorkingSurface surface = test::surface_of(test::torus(48, 24), 0.3, 181);
  const FrameField even = test::torus_frames(surface, 16, 6), odd = test::torus_frames(surface, 5, 3);
  const PeriodicField at_rest = solved(surface, even), frustrated = solved(surface, odd);
  expect_valid(at_rest, surface, even);
  expect_valid(frustrated, surface, odd);
  EXPECT_LT(at_rest.energy, 1e-4);
  EXPECT_GT(frustrated.energy, 10 * at_rest.energy);
}

TEST(PeriodicField, EnergyIsTheSameInEveryGauge) {
  const WorkingSurface surface = test::surface_of(test::box(8), 0.25);
  const FrameField frames = test::smooth_frames(surface, 0.25);
  const PeriodicField field = solved(surface, frames);
  std::vector<int> turns(surface.mesh.face_count());
  for (int f = 0; f < surface.mesh.face_count(); ++f) turns[f] = (f * 7 + f / 3) & 3;
  const FrameField other = test::turned_frames(surface, frames, turns);
  std::vector<PhasePair> psi = field.psi;
  std::vector<GridConstraint> constraint = field.constraint;
  for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
    const int turn = turns[surface.mesh.outgoing(v) / 3];
    psi[v] = turned(psi[v], turn);
    if (turn & 1) {
      if (constraint[v] == GridConstraint::kIsolineU)
        constraint[v] = GridConstraint::kIsolineV;
      else if (constraint[v] == GridConstraint::kIsolineV)
        constraint[v] = GridConstraint::kIsolineU;
    }
  }
  const PeriodicField solved_there = solved(surface, other);
  EXPECT_EQ(solved_there.constraint, constraint);
  const PhaseGraph graph = build_phase_graph(surface.mesh, measure_edges(surface, other),
                                             solved_there.corner_turn, constraint, 20);
  EXPECT_NEAR(phase_energy(graph, psi), field.energy, 1e-9);
}

TEST(PeriodicField, BoxHasItsCornersPinnedAndItsEdgesOnIsolines) {
  const WorkingSurface surface = test::surface_of(test::box(10, {1, 2, 1}), 0.25);
  const FrameField frames = test::smooth_frames(surface, 0.25);
  const PeriodicField field = solved(surface, frames);
  expect_valid(field, surface, frames);
  int corners = 0, isolines = 0;
  for (const GridConstraint c : field.constraint) {
    corners += c == GridConstraint::kCorner;
    isolines += c == GridConstraint::kIsolineU || c == GridConstraint::kIsolineV;
  }
  EXPECT_EQ(corners, 8);
  EXPECT_EQ(isolines, 12 * 9);
}

TEST(PeriodicField, MultilevelIsAsLowAsGaussNewton) {
  const std::vector<std::pair<TriangleMesh, double>> cases = {{test::icosphere(3), 0.25},
                                                              {test::torus(40, 20), 0.2},
                                                              {test::box(8), 0.21},
                                                              {test::capped_cylinder(28, 14), 0.27}};
  for (const auto& [mesh, h] : cases) {
    const WorkingSurface surface = test::surface_of(mesh, h);
    const FrameField frames = test::smooth_frames(surface, h);
    const PeriodicField quick = solved(surface, frames),
                        reference = solved(surface, frames, PeriodicSolver::kEigenGaussNewton);
    expect_valid(quick, surface, frames);
    expect_valid(reference, surface, frames);
    EXPECT_LE(quick.energy, 1.1 * reference.energy + 1e-9);
  }
}

TEST(PeriodicField, SameInputSameBits) {
  const WorkingSurface surface = test::surface_of(test::icosphere(3), 0.2);
  const FrameField frames = test::smooth_frames(surface, 0.2);
  const PeriodicField x = solved(surface, frames), y = solved(surface, frames);
  for (std::size_t v = 0; v < x.psi.size(); ++v)
    ASSERT_TRUE(x.psi[v].a == y.psi[v].a && x.psi[v].b == y.psi[v].b);
}

TEST(PeriodicField, StopsWhenAsked) {
  const WorkingSurface surface = test::surface_of(test::icosphere(3), 0.2);
  const FrameField frames = test::smooth_frames(surface, 0.2);
  RunContext context;
  int polls = 0;
  context.stop_requested = [&] { return ++polls > 2; };
  EXPECT_THROW(solve_periodic_field(surface, frames, PeriodicFieldOptions{}, context), Cancelled);
}

}  // namespace
}  // namespace hybrid_quad
