#include "hybrid_quad/periodic_field/multilevel_phases.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hybrid_quad/numerics/smallest_eigenpair.h"
#include "hybrid_quad/periodic_field/phase_matrix.h"

namespace hybrid_quad {

namespace {

/// Below this many nodes a level is so cheap that it gets five times the sweeps.
constexpr int kCheapLevel = 5000;

/// Projects; where an eigenvector says nothing (without odd holonomy it may vanish on all a or all b)
/// a phase that depends on the node alone takes its place.
void project_all(const PhaseGraph& graph, std::vector<PhasePair>& z) {
  double size = 0;
  for (const PhasePair& p : z) size = std::max({size, std::norm(p.a), std::norm(p.b)});
  for (int i = 0; i < graph.node_count(); ++i) {
    if (std::norm(z[i].a) <= 1e-12 * size) z[i].a = std::polar(1.0, 2.4 * i);
    if (std::norm(z[i].b) <= 1e-12 * size) z[i].b = std::polar(1.0, 2.4 * i);
    z[i] = projected(z[i], graph.constraint[i]);
  }
}

/// Diffusion with projection after every step (Merriman, Bence, Osher 1992), the diffusion time shrinking:
/// the eigenvector is small over whole parts of the surface, and says little there.
void diffuse_and_project(const PhaseGraph& graph, const PhaseMatrix& matrix, std::vector<PhasePair>& z) {
  double mean = 0;
  for (int i = 0; i < graph.node_count(); ++i) mean += 0.5 * (graph.weight_a[i] + graph.weight_b[i]);
  mean = std::max(mean / std::max(1, graph.node_count()), 1e-300);
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
  factor.analyzePattern(matrix.lower);
  for (const double share : {0.0005, 0.0025, 0.01}) {
    factor.setShift(share * mean);
    factor.factorize(matrix.lower);
    if (factor.info() != Eigen::Success) return;
    for (int step = 0; step < 8; ++step) {
      z = phases_of(graph, matrix, factor.solve(unknowns_of(graph, matrix, z)));
      project_all(graph, z);
    }
  }
}

std::vector<PhasePair> solve_coarsest(const PhaseGraph& graph) {
  const PhaseMatrix matrix = assemble_phase_matrix(graph);
  std::vector<PhasePair> z =
      phases_of(graph, matrix, smallest_eigenpair(matrix.lower, EigenOptions{}).vector);
  project_all(graph, z);
  diffuse_and_project(graph, matrix, z);
  return z;
}

}  // namespace

std::vector<PhasePair> solve_multilevel_phases(PhaseGraph finest, const PeriodicFieldOptions& options,
                                               const RunContext& context) {
  std::vector<PhaseGraph> graphs;
  std::vector<PhaseAggregation> lifts;  // without their graphs, which move into `graphs`
  graphs.push_back(std::move(finest));
  while (graphs.back().node_count() > std::max(1, options.coarsest)) {
    PhaseAggregation next = coarsen(graphs.back());
    if (next.coarse.node_count() > 0.9 * graphs.back().node_count()) break;
    graphs.push_back(std::move(next.coarse));
    lifts.push_back(std::move(next));
    context.checkpoint(0.2);
  }
  std::vector<PhasePair> z;
  // A level that cannot be coarsened further (all corners, say) may be too large to factor.
  if (graphs.back().node_count() <= 4 * options.coarsest + 100) {
    z = solve_coarsest(graphs.back());
  } else {
    z.assign(graphs.back().node_count(), PhasePair{});
    project_all(graphs.back(), z);
  }
  for (int level = static_cast<int>(graphs.size()) - 1; level >= 0; --level) {
    const PhaseGraph& graph = graphs[level];
    if (level < static_cast<int>(lifts.size())) {
      std::vector<PhasePair> lifted(graph.node_count());
      for (int i = 0; i < graph.node_count(); ++i)
        lifted[i] = projected(transported(lifts[level].prolongation[i], z[lifts[level].aggregate[i]]),
                              graph.constraint[i]);
      z = std::move(lifted);
    }
    const int sweeps = options.sweeps * (graph.node_count() < kCheapLevel ? 5 : 1);
    for (int s = 0; s < sweeps; s += 2) {
      relax(graph, std::min(2, sweeps - s), z);
      context.checkpoint(0.3 + 0.6 / (1 + level));
    }
  }
  return z;
}

}  // namespace hybrid_quad
