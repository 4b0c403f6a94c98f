#include <gtest/gtest.h>

#include <array>
#include <random>

#include "hybrid_quad/mesh/bucket_sort.h"

namespace hybrid_quad {
namespace {

TEST(BucketSort, SortsAsSortDoes) {
  using Pair = std::array<int, 2>;
  std::mt19937 random(4);
  for (const int count : {0, 1, 500}) {
    std::vector<Pair> list;
    for (int i = 0; i < count; ++i) list.push_back({static_cast<int>(random() % 90), static_cast<int>(random() % 5)});
    std::vector<Pair> expected = list;
    std::sort(expected.begin(), expected.end());
    bucket_sort(list, [](const Pair& x) { return x[0]; }, [](const Pair& x, const Pair& y) { return x < y; });
    EXPECT_EQ(list, expected);
  }
}

TEST(BucketSort, BucketsKeepTheOrderOfTheirElements) {
  using Pair = std::array<int, 2>;
  std::mt19937 random(5);
  for (const int count : {0, 1, 500}) {
    std::vector<Pair> list;
    for (int i = 0; i < count; ++i) list.push_back({static_cast<int>(random() % 40), i});
    std::vector<Pair> expected = list;
    std::sort(expected.begin(), expected.end());
    const std::vector<std::size_t> ends = sort_into_buckets(list, [](const Pair& x) { return x[0]; });
    EXPECT_EQ(list, expected);
    EXPECT_EQ(ends.empty() ? 0 : ends.back(), list.size());
  }
}

}  // namespace
}  // namespace hybrid_quad
