#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace hybrid_quad {

/// Sets of the numbers below a count, each told by its least; at first each number is one.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int set_of(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// \return whether they were in two sets
  bool join(int i, int j) {
    i = set_of(i);
    j = set_of(j);
    parent_[std::max(i, j)] = std::min(i, j);
    return i != j;
  }
  /// The set of each number.
  std::vector<int> sets() {
    std::vector<int> list(parent_.size());
    for (int i = 0; i < static_cast<int>(list.size()); ++i) list[i] = set_of(i);
    return list;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace hybrid_quad
