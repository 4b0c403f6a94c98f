#include "hybrid_quad/periodic_field/gauss_newton_phases.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "hybrid_quad/numerics/smallest_eigenpair.h"
#include "hybrid_quad/periodic_field/phase_matrix.h"

namespace hybrid_quad {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Eq. (18) in the reduced unknowns.
class RelaxedEnergy {
 public:
  RelaxedEnergy(const PhaseGraph& graph, const PhaseMatrix& matrix, double constraint_weight)
      : graph_(graph),
        matrix_(matrix),
        energy_scale_(1 / std::max(graph.total_weight, 1e-300)),
        penalty_scale_(constraint_weight / std::max(1, graph.node_count())) {}

  double value(const Eigen::VectorXd& y) const {
    double penalty = 0;
    for (const PhasePair& z : phases_of(graph_, matrix_, y)) {
      const double x = std::norm(z.a) - 1, w = std::norm(z.b) - 1;
      penalty += 0.5 * (x * x + w * w);
    }
    const Eigen::VectorXd applied = matrix_.lower.selfadjointView<Eigen::Lower>() * y;
    return 0.5 * energy_scale_ * y.dot(applied) + penalty_scale_ * penalty;
  }

  /// Gradient, and the Gauss-Newton matrix: H plus the squared penalty derivatives.
  void linearize(const Eigen::VectorXd& y, Eigen::VectorXd& gradient, Sparse& lower) const {
    gradient = matrix_.lower.selfadjointView<Eigen::Lower>() * y;
    gradient *= energy_scale_;
    lower = energy_scale_ * matrix_.lower;
    std::vector<Eigen::Triplet<double>> extra;
    const std::vector<PhasePair> phases = phases_of(graph_, matrix_, y);
    for (int i = 0; i < graph_.node_count(); ++i) {
      const PhasePair& z = phases[i];
      const Eigen::Matrix4d basis = constraint_basis(graph_.constraint[i]);
      const Eigen::Vector4d da = basis.transpose() * Eigen::Vector4d(2 * z.a.real(), 2 * z.a.imag(), 0, 0);
      const Eigen::Vector4d db = basis.transpose() * Eigen::Vector4d(0, 0, 2 * z.b.real(), 2 * z.b.imag());
      const Eigen::Vector4d slope = (std::norm(z.a) - 1) * da + (std::norm(z.b) - 1) * db;
      const Eigen::Matrix4d curvature = da * da.transpose() + db * db.transpose();
      const int at = matrix_.offset[i], dimension = matrix_.offset[i + 1] - at;
      for (int c = 0; c < dimension; ++c) {
        gradient[at + c] += penalty_scale_ * slope[c];
        for (int r = c; r < dimension; ++r)
          extra.emplace_back(at + r, at + c, penalty_scale_ * curvature(r, c));
      }
    }
    Sparse penalty(lower.rows(), lower.cols());
    penalty.setFromTriplets(extra.begin(), extra.end());
    lower += penalty;
  }

 private:
  const PhaseGraph& graph_;
  const PhaseMatrix& matrix_;
  double energy_scale_, penalty_scale_;
};

}  // namespace

std::vector<PhasePair> solve_gauss_newton_phases(const PhaseGraph& graph, const PeriodicFieldOptions& options,
                                                 const RunContext& context) {
  const PhaseMatrix matrix = assemble_phase_matrix(graph);
  std::vector<PhasePair> z =
      phases_of(graph, matrix, smallest_eigenpair(matrix.lower, EigenOptions{}).vector);
  context.checkpoint(0.3);
  for (int i = 0; i < graph.node_count(); ++i) z[i] = projected(z[i], graph.constraint[i]);
  Eigen::VectorXd y = unknowns_of(graph, matrix, z);
  const RelaxedEnergy energy(graph, matrix, options.constraint_weight);
  Eigen::VectorXd gradient;
  Sparse lower;
  Eigen::SimplicialLDLT<Sparse> factor;
  double value = energy.value(y), first_slope = 0;
  for (int step = 0; step < options.max_newton_steps; ++step) {
    context.checkpoint(0.3 + 0.7 * step / options.max_newton_steps);
    energy.linearize(y, gradient, lower);
    if (step == 0) {
      first_slope = gradient.norm();
      factor.analyzePattern(lower);
    }
    if (gradient.norm() <= options.gradient_tolerance * first_slope) break;
    factor.factorize(lower);
    if (factor.info() != Eigen::Success) break;
    const Eigen::VectorXd direction = -factor.solve(gradient);
    double length = 1;
    Eigen::VectorXd trial = y + direction;
    double trial_value = energy.value(trial);
    while (!(trial_value < value) && length > 1e-6) {
      length *= 0.5;
      trial = y + length * direction;
      trial_value = energy.value(trial);
    }
    if (!(trial_value < value)) break;
    y = trial;
    value = trial_value;
  }
  z = phases_of(graph, matrix, y);
  for (int i = 0; i < graph.node_count(); ++i) z[i] = projected(z[i], graph.constraint[i]);
  return z;
}

}  // namespace hybrid_quad
