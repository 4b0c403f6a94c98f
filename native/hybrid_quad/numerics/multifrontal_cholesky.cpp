#include "hybrid_quad/numerics/multifrontal_cholesky.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <utility>

#include "hybrid_quad/base/parallel_forest.h"

namespace hybrid_quad {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MultifrontalCholesky::MultifrontalCholesky(const SparseMatrix& lower, const std::vector<Vector3>& places, const RunContext& context) {
  EliminationForest forest = nested_dissection(lower, places, context);
  place_.resize(forest.order.size());
  for (std::size_t k = 0; k < forest.order.size(); ++k) place_[forest.order[k]] = static_cast<int>(k);
  fronts_.resize(forest.parts.size());
  for (std::size_t p = 0; p < fronts_.size(); ++p) {
    fronts_[p].begin = forest.parts[p].begin;
    fronts_[p].end = forest.parts[p].end;
    fronts_[p].children = std::move(forest.parts[p].children);
  }
  place_entries(lower);
  find_couplings();
  plan_tasks();
}

void MultifrontalCholesky::place_entries(const SparseMatrix& lower) {
  const int n = static_cast<int>(lower.rows());
  const auto visit = [&](const auto& use) {
    for (int c = 0, entry = 0; c < n; ++c)
      for (SparseMatrix::InnerIterator it(lower, c); it; ++it, ++entry) {
        const int i = place_[it.row()], j = place_[c];
        use(std::min(i, j), std::max(i, j), entry);
      }
  };
  first_.assign(n + 1, 0);
  visit([&](int column, int, int) { ++first_[column + 1]; });
  for (int c = 0; c < n; ++c) first_[c + 1] += first_[c];
  row_.resize(first_[n]);
  entry_.resize(first_[n]);
  std::vector<int> end(first_.begin(), first_.end() - 1);
  visit([&](int column, int row, int entry) {
    row_[end[column]] = row;
    entry_[end[column]++] = entry;
  });
}

void MultifrontalCholesky::find_couplings() {
  std::vector<int> seen(place_.size(), -1);
  for (std::size_t p = 0; p < fronts_.size(); ++p) {
    Front& front = fronts_[p];
    const auto add = [&](int k) {
      if (k < front.end || seen[k] == static_cast<int>(p)) return;
      seen[k] = static_cast<int>(p);
      front.beyond.push_back(k);
    };
    for (int k = first_[front.begin]; k < first_[front.end]; ++k) add(row_[k]);
    for (const int child : front.children)
      for (const int k : fronts_[child].beyond) add(k);
    std::sort(front.beyond.begin(), front.beyond.end());
  }
}

/// Tasks of one thread: a large front alone, or all of a small subtree, which is a range as children come before parents.
void MultifrontalCholesky::plan_tasks() {
  constexpr double kSmall = 2e6;  // operations: about a millisecond
  const int count = static_cast<int>(fronts_.size());
  std::vector<double> work(count);
  std::vector<int> parent(count, -1), begin(count), task(count);
  for (int p = 0; p < count; ++p) {
    const double own = fronts_[p].own(), all = own + static_cast<double>(fronts_[p].beyond.size());
    work[p] = own * all * all;
    begin[p] = p;
    for (const int child : fronts_[p].children) {
      work[p] += work[child];
      parent[child] = p;
      begin[p] = std::min(begin[p], begin[child]);
    }
  }
  const auto is_small = [&](int p) { return work[p] <= kSmall; };
  for (int p = 0; p < count; ++p) {
    if (is_small(p) && parent[p] >= 0 && is_small(parent[p])) continue;
    for (int k = is_small(p) ? begin[p] : p; k <= p; ++k) task[k] = static_cast<int>(task_end_.size());
    task_end_.push_back(p + 1);
  }
  task_parent_.assign(task_end_.size(), -1);
  task_children_.resize(task_end_.size());
  for (std::size_t t = 0; t < task_end_.size(); ++t) {
    const int above = parent[task_end_[t] - 1];
    if (above < 0) continue;
    task_parent_[t] = task[above];
    task_children_[task[above]].push_back(static_cast<int>(t));
  }
}

bool MultifrontalCholesky::factorize(const SparseMatrix& lower, double shift, const RunContext& context) {
  value_.resize(entry_.size());
  for (std::size_t k = 0; k < entry_.size(); ++k) value_[k] = lower.valuePtr()[entry_[k]];
  std::vector<MatrixXd> left_over(fronts_.size());
  RunContext each = context;  // several at once have no common progress
  each.on_progress = nullptr;
  context.checkpoint();
  std::atomic<bool> is_definite{true};
  parallel_forest(task_parent_, context.threads, [&](int t) {
    each.checkpoint();
    for (int p = task_begin(t); p < task_end_[t] && is_definite; ++p)
      if (!eliminate(p, shift, left_over)) is_definite = false;
  });
  return is_definite;
}

/// \param left_over  what every front leaves to its parent, lower triangles; what its children left is used up
bool MultifrontalCholesky::eliminate(std::size_t which, double shift, std::vector<MatrixXd>& left_over) {
  Front& front = fronts_[which];
  MatrixXd& rest = left_over[which];
  const int own = front.own(), beyond = static_cast<int>(front.beyond.size());
  front.column.setZero(own + beyond, own);
  rest.setZero(beyond, beyond);
  const auto local = [&](int place) {
    if (place < front.end) return place - front.begin;
    return own + static_cast<int>(std::lower_bound(front.beyond.begin(), front.beyond.end(), place) - front.beyond.begin());
  };
  for (int c = front.begin; c < front.end; ++c) {
    front.column(c - front.begin, c - front.begin) += shift;
    for (int k = first_[c]; k < first_[c + 1]; ++k) front.column(local(row_[k]), c - front.begin) += value_[k];
  }
  std::vector<int> to;
  for (const int child : front.children) {
    MatrixXd& given = left_over[child];
    to.clear();
    int next = 0;  // both lists ascend
    for (const int k : fronts_[child].beyond) {
      while (k >= front.end && front.beyond[next] != k) ++next;
      to.push_back(k < front.end ? k - front.begin : own + next);
    }
    for (int j = 0; j < given.cols(); ++j)
      for (int i = j; i < given.rows(); ++i)
        (to[j] < own ? front.column(to[i], to[j]) : rest(to[i] - own, to[j] - own)) += given(i, j);
    given.resize(0, 0);
  }
  Eigen::Ref<MatrixXd> pivot = front.column.topRows(own);
  const Eigen::LLT<Eigen::Ref<MatrixXd>> factor(pivot);
  if (factor.info() != Eigen::Success) return false;
  if (beyond == 0) return true;
  auto below = front.column.bottomRows(beyond);
  pivot.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
  rest.selfadjointView<Eigen::Lower>().rankUpdate(below, -1);
  return true;
}

VectorXd MultifrontalCholesky::solve(const VectorXd& right_side, int threads) const {
  VectorXd x(right_side.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) x[place_[i]] = right_side[i];
  std::vector<std::vector<Taken>> taken(task_end_.size());
  parallel_forest(task_parent_, threads, [&](int t) { solve_forwards(t, taken, x); });
  parallel_forest_downwards(task_parent_, threads, [&](int t) { solve_backwards(t, x); });
  VectorXd result(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) result[i] = x[place_[i]];
  return result;
}

/// \param taken  what is to be taken from unknowns behind every task, in the order of the fronts that it comes from, so that it does
///               not matter to a sum which was done first
void MultifrontalCholesky::solve_forwards(int task, std::vector<std::vector<Taken>>& taken, VectorXd& x) const {
  const int end = fronts_[task_end_[task] - 1].end;
  const auto take = [&](int place, double value) {
    if (place < end)
      x[place] -= value;
    else
      taken[task].push_back({place, value});
  };
  for (const int child : task_children_[task])
    for (const Taken& t : taken[child]) take(t.place, t.value);
  VectorXd beyond;
  for (int p = task_begin(task); p < task_end_[task]; ++p) {
    const Front& front = fronts_[p];
    const Eigen::Index own = front.own(), more = static_cast<Eigen::Index>(front.beyond.size());
    beyond.setZero(more);
    for (Eigen::Index j = 0; j < own; ++j) {
      const auto column = front.column.col(j);
      const double value = x[front.begin + j] /= column[j];
      x.segment(front.begin + j + 1, own - j - 1) -= value * column.segment(j + 1, own - j - 1);
      beyond += value * column.tail(more);
    }
    for (Eigen::Index i = 0; i < more; ++i) take(front.beyond[i], beyond[i]);
  }
}

void MultifrontalCholesky::solve_backwards(int task, VectorXd& x) const {
  VectorXd beyond;
  for (int p = task_end_[task]; p-- > task_begin(task);) {
    const Front& front = fronts_[p];
    const Eigen::Index own = front.own(), more = static_cast<Eigen::Index>(front.beyond.size());
    beyond.resize(more);
    for (Eigen::Index i = 0; i < more; ++i) beyond[i] = x[front.beyond[i]];
    for (Eigen::Index j = own - 1; j >= 0; --j) {
      const auto column = front.column.col(j);
      const double known = column.segment(j + 1, own - j - 1).dot(x.segment(front.begin + j + 1, own - j - 1));
      x[front.begin + j] = (x[front.begin + j] - known - column.tail(more).dot(beyond)) / column[j];
    }
  }
}

}  // namespace hybrid_quad
