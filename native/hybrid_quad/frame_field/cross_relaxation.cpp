#include "hybrid_quad/frame_field/cross_relaxation.h"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace hybrid_quad {

namespace {

constexpr double kTiny = 1e-300;

/// A level of the hierarchy: the system, its rows, and how its nodes hang on the next coarser level.
struct Level {
  CrossSystem system;
  std::vector<int> row_begin, neighbour;
  std::vector<Complex> weight;       ///< row i wants z_i along sum of weight * z_neighbour
  std::vector<int> aggregate;        ///< node of the coarser level
  std::vector<Complex> prolongation; ///< z_i = prolongation_i * z_aggregate
  std::vector<Complex> value;
};

void build_rows(Level& level) {
  const int n = level.system.size();
  level.row_begin.assign(n + 1, 0);
  for (const CrossLink& link : level.system.links) {
    ++level.row_begin[link.from + 1];
    ++level.row_begin[link.to + 1];
  }
  for (int i = 0; i < n; ++i) level.row_begin[i + 1] += level.row_begin[i];
  level.neighbour.resize(level.row_begin[n]);
  level.weight.resize(level.row_begin[n]);
  std::vector<int> fill(level.row_begin.begin(), level.row_begin.end() - 1);
  for (const CrossLink& link : level.system.links) {
    level.neighbour[fill[link.to]] = link.from;
    level.weight[fill[link.to]++] = link.weight;
    level.neighbour[fill[link.from]] = link.to;
    level.weight[fill[link.from]++] = std::conj(link.weight);
  }
}

/// Pairs every node with the free neighbour it is tied to most strongly. \return number of aggregates
int aggregate_pairs(Level& level) {
  constexpr double kWeakest = 1e-4;  // relative strength below which two nodes know nothing of each other
  const int n = level.system.size();
  const std::vector<double>& diagonal = level.system.diagonal;
  level.aggregate.assign(n, -1);
  level.prolongation.assign(n, Complex(1, 0));
  int count = 0;
  for (int i = 0; i < n; ++i) {
    if (level.aggregate[i] >= 0) continue;
    int best = -1;
    double strongest = kWeakest;
    for (int e = level.row_begin[i]; e < level.row_begin[i + 1]; ++e) {
      const int j = level.neighbour[e];
      if (level.aggregate[j] >= 0) continue;
      const double strength = std::abs(level.weight[e]) / std::sqrt(diagonal[i] * diagonal[j] + kTiny);
      if (strength > strongest) {
        strongest = strength;
        best = e;
      }
    }
    level.aggregate[i] = count;
    if (best >= 0) {
      const int j = level.neighbour[best];
      level.aggregate[j] = count;
      level.prolongation[j] = std::conj(level.weight[best]) / std::abs(level.weight[best]);
    }
    ++count;
  }
  return count;
}

void merge_parallel_links(std::vector<CrossLink>& links) {
  std::stable_sort(links.begin(), links.end(), [](const CrossLink& x, const CrossLink& y) {
    return std::tie(x.from, x.to) < std::tie(y.from, y.to);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < links.size();) {
    CrossLink merged = links[i++];
    for (; i < links.size() && links[i].from == merged.from && links[i].to == merged.to; ++i)
      merged.weight += links[i].weight;
    links[kept++] = merged;
  }
  links.resize(kept);
}

/// The Galerkin system on the aggregates of `level`.
Level coarsened(const Level& level, int count) {
  Level coarse;
  coarse.system.diagonal.assign(count, 0);
  coarse.system.source.assign(count, Complex(0, 0));
  for (int i = 0; i < level.system.size(); ++i) {
    coarse.system.diagonal[level.aggregate[i]] += level.system.diagonal[i];
    coarse.system.source[level.aggregate[i]] += std::conj(level.prolongation[i]) * level.system.source[i];
  }
  coarse.system.links.reserve(level.system.links.size());
  for (const CrossLink& link : level.system.links) {
    const int p = level.aggregate[link.from], q = level.aggregate[link.to];
    const Complex w = std::conj(level.prolongation[link.to]) * link.weight * level.prolongation[link.from];
    if (p == q) {
      coarse.system.diagonal[p] -= 2 * w.real();
    } else if (p < q) {
      coarse.system.links.push_back({p, q, w});
    } else {
      coarse.system.links.push_back({q, p, std::conj(w)});
    }
  }
  merge_parallel_links(coarse.system.links);
  build_rows(coarse);
  return coarse;
}

/// A direction that depends on the index alone, for starts that must not favour any field.
Complex scattered_direction(std::uint64_t index, std::uint64_t seed) {
  std::uint64_t x = (index + 1) * 0x9E3779B97F4A7C15ull + seed * 0xD1B54A32D192ED03ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  x ^= x >> 31;
  return std::polar(1.0, 6.283185307179586 * static_cast<double>(x >> 11) / 9007199254740992.0);
}

void normalise(std::vector<Complex>& values, std::uint64_t seed) {
  double largest = 0;
  for (const Complex& z : values) largest = std::max(largest, std::abs(z));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double length = std::abs(values[i]);
    values[i] = length > 1e-12 * largest && std::isfinite(length) ? values[i] / length : scattered_direction(i, seed);
  }
}

/// Solves the coarsest level without |z| = 1: a linear system where something pulls, else the lowest eigenvector.
void solve_coarsest(Level& level, std::uint64_t seed) {
  constexpr int kInverseIterations = 20;
  const int n = level.system.size();
  Eigen::MatrixXcd matrix = Eigen::MatrixXcd::Zero(n, n);
  double trace = 0;
  for (const double d : level.system.diagonal) trace += d;
  const double shift = 1e-9 * trace / n + kTiny;
  for (int i = 0; i < n; ++i) matrix(i, i) = level.system.diagonal[i] + shift;
  for (const CrossLink& link : level.system.links) {
    matrix(link.to, link.from) -= link.weight;
    matrix(link.from, link.to) -= std::conj(link.weight);
  }
  const Eigen::LDLT<Eigen::MatrixXcd> factor(matrix);
  Eigen::VectorXcd x(n);
  bool pulled = false;
  for (int i = 0; i < n; ++i) {
    x[i] = level.system.source[i];
    pulled = pulled || x[i] != Complex(0, 0);
  }
  if (pulled) {
    x = factor.solve(x).eval();
  } else {
    for (int i = 0; i < n; ++i) x[i] = scattered_direction(i, seed);
    for (int step = 0; step < kInverseIterations; ++step) {
      x = factor.solve(x).eval();
      const double length = x.norm();
      if (!(length > 0) || !std::isfinite(length)) break;
      x /= length;
    }
  }
  level.value.assign(x.data(), x.data() + n);
  normalise(level.value, seed);
}

/// Nonlinear Gauss-Seidel: every node turns to where its neighbours pull it.
void sweep(Level& level, int sweeps, const RunContext& context) {
  const int n = level.system.size();
  for (int s = 0; s < sweeps; ++s) {
    context.checkpoint(0.5);
    for (int k = 0; k < n; ++k) {
      const int i = s % 2 ? n - 1 - k : k;
      Complex pull = level.system.source[i];
      for (int e = level.row_begin[i]; e < level.row_begin[i + 1]; ++e)
        pull += level.weight[e] * level.value[level.neighbour[e]];
      const double length = std::abs(pull);
      if (length > kTiny) level.value[i] = pull / length;
    }
  }
}

/// The linear operator (diagonal + mass) - links.
void apply(const CrossSystem& system, const std::vector<double>& mass, const std::vector<Complex>& x, std::vector<Complex>& y) {
  for (int i = 0; i < system.size(); ++i) y[i] = (system.diagonal[i] + mass[i]) * x[i];
  for (const CrossLink& link : system.links) {
    y[link.to] -= link.weight * x[link.from];
    y[link.from] -= std::conj(link.weight) * x[link.to];
  }
}

/// Coarse levels decide where cones go and cost little: their sweeps grow as fast as their size allows.
int sweeps_at(const CrossRelaxation& options, std::size_t level) {
  constexpr double kGrowth = 1.5, kMost = 40;
  return static_cast<int>(options.sweeps * std::min(std::pow(kGrowth, static_cast<double>(level)), kMost));
}

}  // namespace

std::vector<Complex> relax_cross_system(const CrossSystem& system, const CrossRelaxation& options, const RunContext& context) {
  if (system.size() == 0) return {};
  std::vector<Level> levels(1);
  levels[0].system = system;
  build_rows(levels[0]);
  while (levels.back().system.size() > options.coarsest) {
    context.checkpoint(0.2);
    Level& fine = levels.back();
    const int count = aggregate_pairs(fine);
    // Nodes without ties stay alone for ever; stop where pairing no longer shrinks the level and a dense solve is in reach.
    if (count > 0.95 * fine.system.size()) break;
    Level coarse = coarsened(fine, count);
    levels.push_back(std::move(coarse));
  }
  constexpr int kLargestDense = 1500;
  Level& coarsest = levels.back();
  if (coarsest.system.size() <= std::max(options.coarsest, kLargestDense)) {
    solve_coarsest(coarsest, context.seed);
  } else {
    coarsest.value = coarsest.system.source;
    normalise(coarsest.value, context.seed);
  }
  sweep(coarsest, 20 * options.sweeps, context);
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    Level& level = levels[l];
    level.value.resize(level.system.size());
    for (int i = 0; i < level.system.size(); ++i)
      level.value[i] = level.prolongation[i] * levels[l + 1].value[level.aggregate[i]];
    normalise(level.value, context.seed);
    sweep(level, sweeps_at(options, l), context);
  }
  return levels[0].value;
}

void diffuse_cross_system(const CrossSystem& system, const std::vector<double>& mass, std::vector<Complex>& z,
                          const RunContext& context) {
  constexpr int kMaxIterations = 60;
  constexpr double kTolerance = 1e-4;
  const int n = system.size();
  std::vector<Complex> residual(n), direction(n), image(n), scaled(n), x = z;
  const auto precondition = [&] {
    double dot = 0;
    for (int i = 0; i < n; ++i) {
      scaled[i] = residual[i] / (system.diagonal[i] + mass[i] + kTiny);
      dot += (std::conj(residual[i]) * scaled[i]).real();
    }
    return dot;
  };
  apply(system, mass, x, image);
  for (int i = 0; i < n; ++i) residual[i] = system.source[i] + mass[i] * z[i] - image[i];
  double rho = precondition();
  const double first = rho;
  direction = scaled;
  for (int step = 0; step < kMaxIterations && rho > kTolerance * kTolerance * first && rho > kTiny; ++step) {
    if (step % 8 == 0) context.checkpoint(0.8);
    apply(system, mass, direction, image);
    double curvature = 0;
    for (int i = 0; i < n; ++i) curvature += (std::conj(direction[i]) * image[i]).real();
    if (!(curvature > 0)) break;
    const double length = rho / curvature;
    for (int i = 0; i < n; ++i) {
      x[i] += length * direction[i];
      residual[i] -= length * image[i];
    }
    const double previous = rho;
    rho = precondition();
    for (int i = 0; i < n; ++i) direction[i] = scaled[i] + (rho / previous) * direction[i];
  }
  for (int i = 0; i < n; ++i) {
    const double length = std::abs(x[i]);
    if (length > 1e-12 && std::isfinite(length)) z[i] = x[i] / length;
  }
}

}  // namespace hybrid_quad
