#include "hybrid_quad/frame_field/cross_relaxation.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hybrid_quad {

namespace {

constexpr double kTiny = 1e-300;

/// Minimises without |z| = 1: a linear system where something pulls, else the lowest eigenvector. Only a start for the sweeps: what pulls, or
/// scattered crosses, will do where rounding leaves no pivot.
std::vector<Complex> solved_linearly(const CrossSystem& system, std::uint64_t seed) {
  constexpr int kInverseIterations = 20;
  const int n = system.size();
  double trace = 0;
  for (const double d : system.diagonal) trace += d;
  const double shift = 1e-9 * trace / n + kTiny;
  std::vector<Eigen::Triplet<Complex>> entries;
  entries.reserve(n + system.links.size());
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, system.diagonal[i] + shift);
  for (const CrossLink& link : system.links) {
    const bool is_below = link.to > link.from;
    entries.emplace_back(is_below ? link.to : link.from, is_below ? link.from : link.to,
                         is_below ? -link.weight : -std::conj(link.weight));
  }
  Eigen::SparseMatrix<Complex> below(n, n);
  below.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<Complex>, Eigen::Lower> factor(below);
  Eigen::VectorXcd x(n);
  bool pulled = false;
  for (int i = 0; i < n; ++i) {
    x[i] = system.source[i];
    pulled = pulled || x[i] != Complex(0, 0);
  }
  const bool is_factorized = factor.info() == Eigen::Success;
  if (is_factorized && pulled) {
    x = factor.solve(x).eval();
  } else if (is_factorized) {
    for (int i = 0; i < n; ++i) x[i] = scattered_cross(i, seed);
    for (int step = 0; step < kInverseIterations; ++step) {
      x = factor.solve(x).eval();
      const double length = x.norm();
      if (!(length > 0) || !std::isfinite(length)) break;
      x /= length;
    }
  }
  std::vector<Complex> values(x.data(), x.data() + n);
  normalise_crosses(values, seed);
  return values;
}

/// Nonlinear Gauss-Seidel: every node turns to where its neighbours pull it.
void sweep(const CrossLevel& level, int sweeps, std::vector<Complex>& values, const RunContext& context) {
  const int n = level.system.size();
  for (int s = 0; s < sweeps; ++s) {
    context.checkpoint(0.5);
    for (int k = 0; k < n; ++k) {
      const int i = s % 2 ? n - 1 - k : k;
      Complex pull = level.system.source[i];
      for (int e = level.row_begin[i]; e < level.row_begin[i + 1]; ++e)
        pull += times(level.weight[e], values[level.neighbour[e]]);
      const double length = std::sqrt(std::norm(pull));  // faster than std::abs, which looks after overflow
      if (length > kTiny) values[i] = pull / length;
    }
  }
}

/// Coarse levels decide where cones go and cost little: their sweeps grow as fast as their size allows.
int sweeps_at(int sweeps, std::size_t level) {
  constexpr double kGrowth = 1.5, kMost = 40;
  return static_cast<int>(sweeps * std::min(std::pow(kGrowth, static_cast<double>(level)), kMost));
}

}  // namespace

std::vector<Complex> relax_crosses(const std::vector<CrossLevel>& levels, int sweeps, const RunContext& context) {
  if (levels[0].system.size() == 0) return {};
  const CrossLevel& coarsest = levels.back();
  std::vector<Complex> values = solved_linearly(coarsest.system, context.seed);
  sweep(coarsest, 20 * sweeps, values, context);
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    values = prolonged(levels[l], values);
    normalise_crosses(values, context.seed);
    sweep(levels[l], sweeps_at(sweeps, l), values, context);
  }
  return values;
}

}  // namespace hybrid_quad
