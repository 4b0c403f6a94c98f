#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace hybrid_quad {

/// Sorts by `less`, whose first criterion is key(x) >= 0, such as an edge's first vertex: linear where keys have few elements each.
template <class T, class Key, class Less>
void bucket_sort(std::vector<T>& list, const Key& key, const Less& less) {
  int most = -1;
  for (const T& x : list) most = std::max(most, key(x));
  std::vector<std::size_t> end(most + 2, 0);  // of each key's bucket, once it is filled
  for (const T& x : list) ++end[key(x) + 1];
  for (int k = 0; k <= most; ++k) end[k + 1] += end[k];
  std::vector<T> sorted(list.size());
  for (const T& x : list) sorted[end[key(x)]++] = x;
  for (int k = 0; k <= most; ++k) std::sort(sorted.begin() + (k > 0 ? end[k - 1] : 0), sorted.begin() + end[k], less);
  list = std::move(sorted);
}

}  // namespace hybrid_quad
