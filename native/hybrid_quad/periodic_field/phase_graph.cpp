#include "hybrid_quad/periodic_field/phase_graph.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/mesh/bucket_sort.h"

namespace hybrid_quad {

namespace {

using Complex = std::complex<double>;

constexpr double kPi = 3.14159265358979323846;

/// The product without the standard's detour for infinities.
inline Complex times(const Complex& x, const Complex& y) {
  return {x.real() * y.real() - x.imag() * y.imag(), x.real() * y.imag() + x.imag() * y.real()};
}

PhaseTransport scaled_to_unit(PhaseTransport t) {
  t.a = unit_phase(t.a);
  t.b = unit_phase(t.b);
  return t;
}

/// Adds up parallel edges that turn alike; those that do not stay apart.
void merge_parallel_edges(std::vector<PhaseEdge>& edges) {
  sort_into_buckets(edges, [](const PhaseEdge& e) { return e.transport.turn; });
  sort_into_buckets(edges, [](const PhaseEdge& e) { return e.to; });
  sort_into_buckets(edges, [](const PhaseEdge& e) { return e.from; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size();) {
    PhaseEdge sum = edges[i];
    std::size_t j = i + 1;
    for (; j < edges.size() && edges[j].from == sum.from && edges[j].to == sum.to &&
           edges[j].transport.turn == sum.transport.turn;
         ++j) {
      sum.transport.a += edges[j].transport.a;
      sum.transport.b += edges[j].transport.b;
    }
    edges[kept++] = sum;
    i = j;
  }
  edges.resize(kept);
}

int rank(GridConstraint c) { return c == GridConstraint::kFree ? 0 : c == GridConstraint::kCorner ? 2 : 1; }

/// Whether two constrained nodes can be one: an aggregate has a single constraint.
bool can_join(GridConstraint x, GridConstraint y, int turn) {
  if (rank(x) + rank(y) < 2) return true;
  if (rank(x) == 2 && rank(y) == 2) return false;
  if (rank(x) == 1 && rank(y) == 1) return (x == y) == ((turn & 1) == 0);
  return true;
}

/// The strongest edge from node i to one that has no aggregate yet, as an index into `incoming`, or -1.
int strongest_partner(const PhaseGraph& g, int i, const std::vector<int>& aggregate) {
  int best = -1;
  double best_strength = 1e-4;
  for (int e = g.first[i]; e < g.first[i + 1]; ++e) {
    const int j = g.neighbour[e];
    if (aggregate[j] >= 0 || j == i) continue;
    const PhaseTransport& t = g.incoming[e];
    if (!can_join(g.constraint[i], g.constraint[j], t.turn)) continue;
    const double scale = (g.weight_a[i] + g.weight_b[i]) * (g.weight_a[j] + g.weight_b[j]);
    const double strength = std::sqrt(std::min(std::norm(t.a), std::norm(t.b)) / std::max(scale, 1e-300));
    if (strength > best_strength) {
      best_strength = strength;
      best = e;
    }
  }
  return best;
}

/// Galerkin edges: transports between the aggregates' values; those inside an aggregate lower its own weight.
void project_edges(const PhaseGraph& fine, PhaseAggregation& result) {
  PhaseGraph& coarse = result.coarse;
  for (int i = 0; i < fine.node_count(); ++i) {
    const int c = result.aggregate[i];
    const bool swapped = result.prolongation[i].turn & 1;
    coarse.weight_a[c] += swapped ? fine.weight_b[i] : fine.weight_a[i];
    coarse.weight_b[c] += swapped ? fine.weight_a[i] : fine.weight_b[i];
  }
  coarse.edges.reserve(fine.edges.size());
  for (const PhaseEdge& e : fine.edges) {
    int p = result.aggregate[e.from], q = result.aggregate[e.to];
    PhaseTransport t =
        composed(adjoint(result.prolongation[e.to]), composed(e.transport, result.prolongation[e.from]));
    if (p == q) {
      if (t.turn == 0) {
        coarse.weight_a[p] -= 2 * t.a.real();
        coarse.weight_b[p] -= 2 * t.b.real();
      }
      continue;
    }
    if (p > q) {
      t = adjoint(t);
      std::swap(p, q);
    }
    coarse.edges.push_back({p, q, t});
  }
  merge_parallel_edges(coarse.edges);
}

PhasePair mean_of_neighbours(const PhaseGraph& graph, int i, const std::vector<PhasePair>& z) {
  PhasePair sum{{0, 0}, {0, 0}};
  for (int e = graph.first[i]; e < graph.first[i + 1]; ++e) {
    const PhasePair t = transported(graph.incoming[e], z[graph.neighbour[e]]);
    sum.a += t.a;
    sum.b += t.b;
  }
  return sum;
}

}  // namespace

PhasePair transported(const PhaseTransport& t, const PhasePair& z) {
  return turned(PhasePair{times(t.a, z.a), times(t.b, z.b)}, t.turn);
}

PhaseTransport composed(const PhaseTransport& second, const PhaseTransport& first) {
  const PhasePair r = turned(PhasePair{second.a, second.b}, inverse_turns(first.turn));
  return {wrap_turns(second.turn + first.turn), times(first.a, r.a), times(first.b, r.b)};
}

PhaseTransport adjoint(const PhaseTransport& t) {
  const PhasePair r = turned(PhasePair{std::conj(t.a), std::conj(t.b)}, t.turn);
  return {inverse_turns(t.turn), r.a, r.b};
}

Complex unit_phase(const Complex& z) {
  const double length = std::sqrt(std::norm(z));
  return length > 1e-150 ? z / length : Complex(1, 0);
}

PhasePair projected(const PhasePair& z, GridConstraint constraint) {
  switch (constraint) {
    case GridConstraint::kFree:
      return {unit_phase(z.a), unit_phase(z.b)};
    case GridConstraint::kIsolineV: {
      const Complex c = unit_phase(z.a + z.b);
      return {c, c};
    }
    case GridConstraint::kIsolineU: {
      const Complex c = unit_phase(z.a + std::conj(z.b));
      return {c, std::conj(c)};
    }
    default: {
      const double sign = z.a.real() + z.b.real() >= 0 ? 1 : -1;
      return {Complex(sign, 0), Complex(sign, 0)};
    }
  }
}

double edge_weight(const TriangleMesh& mesh, int h) {
  const double squared = mesh.edge_vector(h).squaredNorm();
  const double weight = squared > 0 ? mesh.area(TriangleMesh::face_of(h)) / (2 * squared) : 0;
  return std::isfinite(weight) ? std::clamp(weight, 1e-3, 1e2) : 1e-3;
}

void PhaseGraph::index_edges() {
  first.assign(node_count() + 1, 0);
  for (const PhaseEdge& e : edges) {
    ++first[e.from + 1];
    ++first[e.to + 1];
  }
  for (int i = 0; i < node_count(); ++i) first[i + 1] += first[i];
  neighbour.resize(2 * edges.size());
  incoming.resize(2 * edges.size());
  std::vector<int> cursor(first.begin(), first.end() - 1);
  for (const PhaseEdge& e : edges) {
    neighbour[cursor[e.to]] = e.from;
    incoming[cursor[e.to]++] = e.transport;
    neighbour[cursor[e.from]] = e.to;
    incoming[cursor[e.from]++] = adjoint(e.transport);
  }
}

PhaseGraph build_phase_graph(const TriangleMesh& mesh, const GridMeasure& measure,
                             const std::vector<std::uint8_t>& corner_turn,
                             std::vector<GridConstraint> constraint, double feature_weight) {
  PhaseGraph graph;
  graph.constraint = std::move(constraint);
  graph.weight_a.assign(graph.node_count(), 0.0);
  const auto add_side = [&](int h, bool reversed) {
    int p = mesh.from(h), q = mesh.to(h);
    double w = edge_weight(mesh, h);
    if (measure.axis[h] >= 0) w *= feature_weight;
    graph.weight_a[p] += w;
    graph.weight_a[q] += w;
    graph.total_weight += w;
    const int kp = corner_turn[h], kq = corner_turn[TriangleMesh::next(h)];
    const double alpha = kPi * (measure.along[h][0] + measure.along[h][1]);
    const double beta = kPi * (measure.along[h][0] - measure.along[h][1]);
    const PhasePair step = turned(PhasePair{std::polar(w, alpha), std::polar(w, beta)}, inverse_turns(kp));
    PhaseTransport t{wrap_turns(kp - kq), step.a, step.b};
    if (p > q) t = adjoint(t);
    PhaseEdge* same = reversed ? &graph.edges.back() : nullptr;
    if (same && same->transport.turn == t.turn) {
      same->transport.a += t.a;
      same->transport.b += t.b;
    } else {
      graph.edges.push_back({std::min(p, q), std::max(p, q), t});
    }
  };
  graph.edges.reserve(mesh.halfedge_count() / 2 + 16);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o > h || mesh.from(h) == mesh.to(h)) continue;
    add_side(h, false);
    if (o >= 0) add_side(o, true);
  }
  graph.weight_b = graph.weight_a;
  graph.index_edges();
  return graph;
}

void relax(const PhaseGraph& graph, int sweeps, std::vector<PhasePair>& z) {
  const int n = graph.node_count();
  for (int s = 0; s < sweeps; ++s)
    for (int k = 0; k < n; ++k) {
      const int i = (s & 1) ? n - 1 - k : k;
      if (graph.first[i] == graph.first[i + 1]) continue;
      z[i] = projected(mean_of_neighbours(graph, i, z), graph.constraint[i]);
    }
}

double phase_energy(const PhaseGraph& graph, const std::vector<PhasePair>& z) {
  double energy = 0;
  for (int i = 0; i < graph.node_count(); ++i)
    energy += 0.5 * (graph.weight_a[i] * std::norm(z[i].a) + graph.weight_b[i] * std::norm(z[i].b));
  for (const PhaseEdge& e : graph.edges) {
    const PhasePair t = transported(e.transport, z[e.from]);
    energy -= times(t.a, std::conj(z[e.to].a)).real() + times(t.b, std::conj(z[e.to].b)).real();
  }
  return graph.total_weight > 0 ? std::max(0.0, energy) / graph.total_weight : 0;
}

PhaseAggregation coarsen(const PhaseGraph& fine) {
  PhaseAggregation result;
  const int n = fine.node_count();
  result.aggregate.assign(n, -1);
  result.prolongation.assign(n, PhaseTransport{});
  for (int i = 0; i < n; ++i) {
    if (result.aggregate[i] >= 0) continue;
    const int c = result.coarse.node_count();
    result.aggregate[i] = c;
    result.coarse.constraint.push_back(fine.constraint[i]);
    const int e = strongest_partner(fine, i, result.aggregate);
    if (e < 0) continue;
    const int j = fine.neighbour[e];
    result.aggregate[j] = c;
    const PhaseTransport to_i = scaled_to_unit(fine.incoming[e]);
    // The aggregate's value is that of its more constrained node.
    if (rank(fine.constraint[j]) > rank(fine.constraint[i])) {
      result.prolongation[i] = to_i;
      result.coarse.constraint[c] = fine.constraint[j];
    } else {
      result.prolongation[j] = adjoint(to_i);
    }
  }
  result.coarse.total_weight = fine.total_weight;
  result.coarse.weight_a.assign(result.coarse.node_count(), 0.0);
  result.coarse.weight_b = result.coarse.weight_a;
  project_edges(fine, result);
  result.coarse.index_edges();
  return result;
}

}  // namespace hybrid_quad
