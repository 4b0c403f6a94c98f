#include "hybrid_quad/frame_field/smoothest_crosses.h"

#include <Eigen/SparseCore>
#include <algorithm>

#include "hybrid_quad/numerics/smallest_eigenpair.h"
#include "hybrid_quad/numerics/sparse_solve.h"

namespace hybrid_quad {

namespace {

/// The quadratic form on (real, imaginary) parts, lower triangle.
SparseMatrix real_form(const CrossSystem& system) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * system.size() + 4 * system.links.size());
  for (int i = 0; i < 2 * system.size(); ++i) entries.emplace_back(i, i, system.diagonal[i / 2]);
  for (const CrossLink& link : system.links) {
    const int row = 2 * link.to, column = 2 * link.from;  // to > from: below the diagonal
    const double re = link.weight.real(), im = link.weight.imag();
    entries.emplace_back(row, column, -re);
    entries.emplace_back(row, column + 1, im);
    entries.emplace_back(row + 1, column, -im);
    entries.emplace_back(row + 1, column + 1, -re);
  }
  SparseMatrix matrix(2 * system.size(), 2 * system.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<Complex> solved_directly(const CrossSystem& system, const RunContext& context) {
  Eigen::VectorXd source(2 * system.size());
  for (int i = 0; i < system.size(); ++i) {
    source[2 * i] = system.source[i].real();
    source[2 * i + 1] = system.source[i].imag();
  }
  const SparseMatrix matrix = real_form(system);
  const Eigen::VectorXd x =
      source.isZero(0) ? smallest_eigenpair(matrix, EigenOptions{}).vector : solve_sparse(matrix, source, {}, context);
  std::vector<Complex> values(system.size());
  for (int i = 0; i < system.size(); ++i) values[i] = {x[2 * i], x[2 * i + 1]};
  return values;
}

/// Linear Gauss-Seidel.
void sweep(const CrossLevel& level, int sweeps, std::vector<Complex>& values, const RunContext& context) {
  const int n = level.system.size();
  for (int s = 0; s < sweeps; ++s) {
    context.checkpoint(0.6);
    for (int k = 0; k < n; ++k) {
      const int i = s % 2 ? n - 1 - k : k;
      if (!(level.system.diagonal[i] > 0)) continue;
      Complex pull = level.system.source[i];
      for (int e = level.row_begin[i]; e < level.row_begin[i + 1]; ++e) pull += times(level.weight[e], values[level.neighbour[e]]);
      values[i] = pull / level.system.diagonal[i];
    }
  }
}

}  // namespace

std::vector<Complex> smoothest_crosses(const std::vector<CrossLevel>& levels, int sweeps, const RunContext& context) {
  constexpr int kSolvedDirectly = 5000;
  std::size_t start = 0;
  while (start + 1 < levels.size() && levels[start].system.size() > kSolvedDirectly) ++start;
  if (levels[start].system.size() == 0) return {};
  std::vector<Complex> values = solved_directly(levels[start].system, context);
  for (std::size_t l = start; l-- > 0;) {
    values = prolonged(levels[l], values);
    sweep(levels[l], sweeps, values, context);
  }
  normalise_crosses(values, context.seed);
  return values;
}

}  // namespace hybrid_quad
