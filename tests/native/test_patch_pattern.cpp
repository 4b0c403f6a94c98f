#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "hybrid_quad/improve/patch_pattern.h"

namespace hybrid_quad {
namespace {

/// A pattern must be a disk of quads whose border is the one given, with one quad at the corners and two at other vertices.
void expect_fills(const PatchPattern& pattern, const std::vector<int>& sides, bool has_corners = true) {
  const int border = std::accumulate(sides.begin(), sides.end(), 0);
  std::vector<int> valence(pattern.vertex_count, 0), wanted(border, 2);
  std::map<std::pair<int, int>, int> edges;
  for (const auto& quad : pattern.quads)
    for (int i = 0; i < 4; ++i) {
      ++valence.at(quad[i]);
      const int uses = ++edges[{quad[i], quad[(i + 1) % 4]}];
      EXPECT_EQ(uses, 1);
    }
  int v = 0;
  for (const int length : sides) {
    if (has_corners) wanted[v] = 1;
    v += length;
  }
  int open = 0;
  for (const auto& [edge, count] : edges)
    if (edges.count({edge.second, edge.first}) == 0) {
      ++open;
      EXPECT_LT(edge.first, border);
      EXPECT_EQ(edge.second, (edge.first + 1) % border);
    }
  EXPECT_EQ(open, border);
  const int edge_count = (static_cast<int>(edges.size()) + open) / 2;
  EXPECT_EQ(pattern.vertex_count - edge_count + static_cast<int>(pattern.quads.size()), 1);
  for (int i = 0; i < border; ++i) EXPECT_EQ(valence[i], wanted[i]);
  int irregular = 0;
  for (int i = border; i < pattern.vertex_count; ++i) {
    EXPECT_GE(valence[i], 3);
    EXPECT_LE(valence[i], 5);
    irregular += valence[i] != 4;
  }
  EXPECT_EQ(irregular, pattern.irregular);
}

TEST(PatchPattern, FourSidesThatFitAreAGrid) {
  const auto patterns = patch_patterns({3, 5, 3, 5}, 15, 4);
  ASSERT_EQ(patterns.size(), 1u);
  EXPECT_EQ(patterns[0].quads.size(), 15u);
  EXPECT_EQ(patterns[0].irregular, 0);
  expect_fills(patterns[0], {3, 5, 3, 5});
}

/// Counted by trying every cut of every length.
TEST(PatchPattern, NoPatternIsLeftOut) {
  constexpr std::size_t kAll = 100000;
  EXPECT_EQ(patch_patterns({5, 7}, 20, kAll).size(), 16u);
  EXPECT_EQ(patch_patterns({4, 6, 8, 8}, 20, kAll).size(), 72u);
  EXPECT_EQ(patch_patterns({3, 4, 5, 3, 6, 5}, 20, kAll).size(), 10u);
}

TEST(PatchPattern, EveryPatternFillsItsDisk) {
  std::map<std::size_t, int> found;
  const auto all = [&](auto&& self, std::vector<int>& sides, std::size_t corners, int longest) -> void {
    if (sides.size() == corners) {
      for (const PatchPattern& pattern : patch_patterns(sides, 20, 3)) {
        ++found[corners];
        expect_fills(pattern, sides);
        EXPECT_EQ(pattern.irregular % 2, static_cast<int>(corners) % 2);
      }
      return;
    }
    for (int length = 1; length <= longest; ++length) {
      sides.push_back(length);
      self(self, sides, corners, longest);
      sides.pop_back();
    }
  };
  for (const auto& [corners, longest] : {std::pair<std::size_t, int>{2, 9}, {3, 6}, {4, 5}, {5, 4}, {6, 3}}) {
    std::vector<int> sides;
    all(all, sides, corners, longest);
    EXPECT_GT(found[corners], 0);
  }
}

TEST(PatchPattern, NothingWhereLengthsDoNotFit) {
  EXPECT_TRUE(patch_patterns({2, 2, 3}, 6, 4).empty());  // an odd border
  EXPECT_TRUE(patch_patterns({2, 2, 8}, 6, 4).empty());  // no triangle
  EXPECT_TRUE(patch_patterns({4}, 6, 4).empty());
  EXPECT_TRUE(patch_patterns({1, 1, 1, 1, 1, 1, 2}, 6, 4).empty());
  EXPECT_TRUE(round_patterns(7, 4).empty());
}

TEST(PatchPattern, OfSeveralTheNearestInNumberComesFirst) {
  for (const int wanted : {8, 20, 40}) {
    const auto patterns = patch_patterns({6, 6, 5, 5}, wanted, 1000);
    ASSERT_GT(patterns.size(), 1u);
    const auto off = [&](const PatchPattern& p) { return std::abs(static_cast<int>(p.quads.size()) - wanted); };
    for (std::size_t i = 1; i < patterns.size(); ++i) EXPECT_LE(off(patterns[i - 1]), off(patterns[i]));
  }
}

TEST(PatchPattern, RoundOnesHaveFourThrees) {
  for (const int edges : {4, 6, 12, 18}) {
    const auto patterns = round_patterns(edges, 3);
    EXPECT_EQ(patterns.size(), std::min<std::size_t>(3, edges / 2));
    for (const PatchPattern& pattern : patterns) {
      EXPECT_EQ(pattern.irregular, 4);
      expect_fills(pattern, {edges}, false);
    }
  }
}

}  // namespace
}  // namespace hybrid_quad
