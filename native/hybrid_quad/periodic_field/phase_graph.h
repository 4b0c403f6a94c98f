#pragma once

#include <vector>

#include "hybrid_quad/periodic_field/grid_measure.h"
#include "hybrid_quad/periodic_field/periodic_field.h"

namespace hybrid_quad {

/// A weighted transport of phases: (a, b) -> turned((factor_a a, factor_b b), turn). Transports compose and
/// have adjoints (as real-linear maps), so coarse graphs have the same form as fine ones.
struct PhaseTransport {
  int turn = 0;
  std::complex<double> a{1, 0};
  std::complex<double> b{1, 0};
};

PhasePair transported(const PhaseTransport& t, const PhasePair& z);
/// First `first`, then `second`.
PhaseTransport composed(const PhaseTransport& second, const PhaseTransport& first);
PhaseTransport adjoint(const PhaseTransport& t);
/// z / |z|, and 1 for what has no direction.
std::complex<double> unit_phase(const std::complex<double>& z);

struct PhaseEdge {
  int from, to;  ///< from < to
  PhaseTransport transport;
};

/// The quadratic form of Eq. (16) on nodes that carry phases: vertices on the finest level, aggregates on the
/// others. E = 1/2 sum_i (weight_a |a_i|^2 + weight_b |b_i|^2) - sum_edges Re <z_to, T z_from>.
struct PhaseGraph {
  std::vector<GridConstraint> constraint;
  std::vector<double> weight_a, weight_b;
  std::vector<PhaseEdge> edges;
  std::vector<int> first, neighbour;     ///< edges seen from either end, node by node
  std::vector<PhaseTransport> incoming;  ///< from neighbour to the node
  double total_weight = 0;               ///< of all half-edges on the finest level

  int node_count() const { return static_cast<int>(constraint.size()); }
  void index_edges();
};

/// Half-edge weights |t| / (2 |e|^2), times feature_weight on feature edges (paper 3.2), bounded for slivers.
PhaseGraph build_phase_graph(const TriangleMesh& mesh, const GridMeasure& measure,
                             const std::vector<std::uint8_t>& corner_turn,
                             std::vector<GridConstraint> constraint, double feature_weight);
double edge_weight(const TriangleMesh& mesh, int h);

/// The nearest value with |a| = |b| = 1 that the constraint allows.
PhasePair projected(const PhasePair& z, GridConstraint constraint);

/// Nonlinear Gauss-Seidel: every node becomes the projected mean of its neighbours' transported values;
/// alternating order.
void relax(const PhaseGraph& graph, int sweeps, std::vector<PhasePair>& z);

/// E / total_weight.
double phase_energy(const PhaseGraph& graph, const std::vector<PhasePair>& z);

/// A graph of pairs of nodes, joined along their strongest edges, with the transports that lift its values
/// back.
struct PhaseAggregation {
  PhaseGraph coarse;
  std::vector<int> aggregate;
  std::vector<PhaseTransport> prolongation;  ///< unit: from the aggregate's value to the node's
};
PhaseAggregation coarsen(const PhaseGraph& fine);

}  // namespace hybrid_quad
