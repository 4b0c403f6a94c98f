#include "hybrid_quad/numerics/aggregation_multigrid.h"

#include <cmath>
#include <utility>

namespace hybrid_quad {

namespace {

constexpr int kCoarsest = 300;      // unknowns that a dense factorization may have
constexpr double kStalled = 0.9;    // a level that shrinks less than this is the last one
constexpr double kTiny = 1e-300;

}  // namespace

void AggregationMultigrid::Level::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  y.resize(size());
  for (int i = 0; i < size(); ++i) {
    double sum = diagonal[i] * x[i];
    for (int e = row_begin[i]; e < row_begin[i + 1]; ++e) sum += value[e] * x[column[e]];
    y[i] = sum;
  }
}

void AggregationMultigrid::Level::smooth_forward(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  for (int i = 0; i < size(); ++i) {
    double sum = b[i];
    for (int e = row_begin[i]; e < row_begin[i + 1]; ++e) sum -= value[e] * x[column[e]];
    x[i] = sum / diagonal[i];
  }
}

void AggregationMultigrid::Level::smooth_backward(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  for (int i = size() - 1; i >= 0; --i) {
    double sum = b[i];
    for (int e = row_begin[i]; e < row_begin[i + 1]; ++e) sum -= value[e] * x[column[e]];
    x[i] = sum / diagonal[i];
  }
}

AggregationMultigrid::AggregationMultigrid(const SparseMatrix& lower) {
  Level finest;
  const int n = static_cast<int>(lower.rows());
  finest.diagonal = Eigen::VectorXd::Zero(n);
  finest.row_begin.assign(n + 1, 0);
  for (int c = 0; c < lower.outerSize(); ++c)
    for (SparseMatrix::InnerIterator it(lower, c); it; ++it) {
      if (it.row() == it.col()) {
        finest.diagonal[c] += it.value();
      } else {
        ++finest.row_begin[it.row() + 1];
        ++finest.row_begin[it.col() + 1];
      }
    }
  for (int i = 0; i < n; ++i) finest.row_begin[i + 1] += finest.row_begin[i];
  finest.column.resize(finest.row_begin[n]);
  finest.value.resize(finest.row_begin[n]);
  std::vector<int> fill(finest.row_begin.begin(), finest.row_begin.end() - 1);
  for (int c = 0; c < lower.outerSize(); ++c)
    for (SparseMatrix::InnerIterator it(lower, c); it; ++it) {
      const int i = static_cast<int>(it.row()), j = static_cast<int>(it.col());
      if (i == j) continue;
      finest.column[fill[i]] = j;
      finest.value[fill[i]++] = it.value();
      finest.column[fill[j]] = i;
      finest.value[fill[j]++] = it.value();
    }
  for (int i = 0; i < n; ++i)
    if (!(finest.diagonal[i] > kTiny)) finest.diagonal[i] = 1;  // an unknown that nothing asks about
  levels_.push_back(std::move(finest));
  while (levels_.back().size() > kCoarsest) {
    Level& fine = levels_.back();
    Level pairs = coarsened(fine, pair_unknowns(fine));
    if (pairs.size() > kStalled * fine.size()) break;
    // Two pairings make one level of aggregates of four.
    const int count = pair_unknowns(pairs);
    Level coarse = coarsened(pairs, count);
    for (int i = 0; i < fine.size(); ++i) {
      const int p = fine.aggregate[i];
      fine.aggregate[i] = pairs.aggregate[p];
      fine.sign[i] *= pairs.sign[p];
    }
    levels_.push_back(std::move(coarse));
  }
  const Level& last = levels_.back();
  coarsest_is_dense_ = last.size() <= 4 * kCoarsest;
  if (coarsest_is_dense_) {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(last.size(), last.size());
    for (int i = 0; i < last.size(); ++i) {
      dense(i, i) = last.diagonal[i] * (1 + 1e-13);
      for (int e = last.row_begin[i]; e < last.row_begin[i + 1]; ++e) dense(i, last.column[e]) += last.value[e];
    }
    coarsest_.compute(dense);
  }
}

int AggregationMultigrid::pair_unknowns(Level& level) {
  constexpr double kWeakest = 0.02;  // couplings below this share of the diagonals are not worth a pair
  level.aggregate.assign(level.size(), -1);
  level.sign.assign(level.size(), 1);
  int count = 0;
  for (int i = 0; i < level.size(); ++i) {
    if (level.aggregate[i] >= 0) continue;
    int best = -1;
    double strongest = kWeakest;
    for (int e = level.row_begin[i]; e < level.row_begin[i + 1]; ++e) {
      const int j = level.column[e];
      if (level.aggregate[j] >= 0) continue;
      const double strength = std::abs(level.value[e]) / std::sqrt(level.diagonal[i] * level.diagonal[j]);
      if (strength > strongest) {
        strongest = strength;
        best = e;
      }
    }
    level.aggregate[i] = count;
    if (best >= 0) {
      level.aggregate[level.column[best]] = count;
      level.sign[level.column[best]] = level.value[best] > 0 ? -1 : 1;
    }
    ++count;
  }
  return count;
}

AggregationMultigrid::Level AggregationMultigrid::coarsened(const Level& level, int count) {
  std::vector<int> member_begin(count + 1, 0), member(level.size());
  for (int i = 0; i < level.size(); ++i) ++member_begin[level.aggregate[i] + 1];
  for (int c = 0; c < count; ++c) member_begin[c + 1] += member_begin[c];
  std::vector<int> fill(member_begin.begin(), member_begin.end() - 1);
  for (int i = 0; i < level.size(); ++i) member[fill[level.aggregate[i]]++] = i;

  Level coarse;
  coarse.diagonal = Eigen::VectorXd::Zero(count);
  coarse.row_begin.assign(1, 0);
  coarse.row_begin.reserve(count + 1);
  coarse.column.reserve(level.column.size() / 2);
  coarse.value.reserve(level.column.size() / 2);
  std::vector<int> position(count, -1);
  for (int c = 0; c < count; ++c) {
    const int begin = coarse.row_begin.back();
    double floor = 0;
    for (int m = member_begin[c]; m < member_begin[c + 1]; ++m) {
      const int i = member[m];
      coarse.diagonal[c] += level.diagonal[i];
      floor += level.diagonal[i];
      for (int e = level.row_begin[i]; e < level.row_begin[i + 1]; ++e) {
        const int j = level.column[e], d = level.aggregate[j];
        const double v = level.sign[i] * level.sign[j] * level.value[e];
        if (d == c) {
          coarse.diagonal[c] += v;
        } else if (position[d] < begin) {
          position[d] = static_cast<int>(coarse.column.size());
          coarse.column.push_back(d);
          coarse.value.push_back(v);
        } else {
          coarse.value[position[d]] += v;
        }
      }
    }
    // Rounding must not make an aggregate that nothing holds indefinite.
    coarse.diagonal[c] = std::max(coarse.diagonal[c], 1e-14 * floor);
    coarse.row_begin.push_back(static_cast<int>(coarse.column.size()));
  }
  return coarse;
}

void AggregationMultigrid::cycle(std::size_t l, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  Level& level = levels_[l];
  if (l + 1 == levels_.size()) {
    if (coarsest_is_dense_) {
      x = coarsest_.solve(b);
      return;
    }
    x.setZero(level.size());
    for (int sweep = 0; sweep < 10; ++sweep) {
      level.smooth_forward(b, x);
      level.smooth_backward(b, x);
    }
    return;
  }
  x.setZero(level.size());
  level.smooth_forward(b, x);
  level.multiply(x, level.residual);
  level.residual = b - level.residual;
  Level& coarse = levels_[l + 1];
  coarse.right_side.setZero(coarse.size());
  for (int i = 0; i < level.size(); ++i) coarse.right_side[level.aggregate[i]] += level.sign[i] * level.residual[i];
  solve_coarse(l + 1);
  for (int i = 0; i < level.size(); ++i) x[i] += level.sign[i] * coarse.solution[level.aggregate[i]];
  level.smooth_backward(b, x);
}

/// solution ~ A^-1 right_side by up to two steps of flexible conjugate gradients, preconditioned by the next cycle.
void AggregationMultigrid::solve_coarse(std::size_t l) {
  constexpr double kGoodEnough = 0.25;
  Level& level = levels_[l];
  if (l + 1 == levels_.size() && coarsest_is_dense_) {
    level.solution = coarsest_.solve(level.right_side);
    return;
  }
  const double size = level.right_side.norm();
  Eigen::VectorXd rest = level.right_side;
  cycle(l, level.right_side, level.direction);
  level.multiply(level.direction, level.image);
  const double curvature = level.direction.dot(level.image);
  if (!(curvature > kTiny)) {
    level.solution = level.direction;
    return;
  }
  const double step = level.direction.dot(level.right_side) / curvature;
  level.solution = step * level.direction;
  rest -= step * level.image;
  if (rest.norm() <= kGoodEnough * size) return;
  cycle(l, rest, level.second);
  level.multiply(level.second, level.second_image);
  const double overlap = level.second.dot(level.image) / curvature;
  level.second -= overlap * level.direction;
  level.second_image -= overlap * level.image;
  const double second_curvature = level.second.dot(level.second_image);
  if (second_curvature > kTiny) level.solution += (level.second.dot(rest) / second_curvature) * level.second;
}

}  // namespace hybrid_quad
