#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace hybrid_quad {

/// Sorts by key(x) >= 0, such as an edge's first vertex; elements of one key keep their order. Linear time.
/// \return where the elements of each key end
template <class T, class Key>
std::vector<std::size_t> sort_into_buckets(std::vector<T>& list, const Key& key) {
  int most = -1;
  for (const T& x : list) most = std::max(most, key(x));
  std::vector<std::size_t> end(most + 2, 0);  // of each key's bucket, once it is filled
  for (const T& x : list) ++end[key(x) + 1];
  for (int k = 0; k <= most; ++k) end[k + 1] += end[k];
  std::vector<T> sorted(list.size());
  for (const T& x : list) sorted[end[key(x)]++] = x;
  list = std::move(sorted);
  end.pop_back();
  return end;
}

/// Sorts by `less`, whose first criterion is key(x) >= 0: linear where keys have few elements each.
template <class T, class Key, class Less>
void bucket_sort(std::vector<T>& list, const Key& key, const Less& less) {
  std::size_t begin = 0;
  for (const std::size_t end : sort_into_buckets(list, key)) {
    std::sort(list.begin() + begin, list.begin() + end, less);
    begin = end;
  }
}

}  // namespace hybrid_quad
