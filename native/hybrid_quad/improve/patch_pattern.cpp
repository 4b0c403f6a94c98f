#include "hybrid_quad/improve/patch_pattern.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace hybrid_quad {

namespace {

using Path = std::vector<int>;  // vertices

/// Twice the lengths of the spokes from a star's middle to its sides, each of which its two neighbours share: sides[i] =
/// spokes[i - 1] + spokes[i + 1]. They are all odd or all even. \pre an odd number of sides
std::vector<int> doubled_spokes(const std::vector<int>& sides) {
  const int n = static_cast<int>(sides.size());
  std::vector<int> spokes(n, 0);
  for (int i = 0; i < n; ++i) spokes[0] += (i % 2 ? -1 : 1) * sides[(2 * i + 1) % n];  // going around by twos
  for (int i = 0, k = 0; i + 1 < n; ++i, k = (k + 2) % n) spokes[(k + 2) % n] = 2 * sides[(k + 1) % n] - spokes[k];
  return spokes;
}

/// Lengths of the spokes, empty where they are not whole and positive. \pre an odd number of sides
/// \param least_last  the least length of the last side's spoke; without any the star's middle lies on that side
std::vector<int> star_spokes(const std::vector<int>& sides, int least_last = 1) {
  std::vector<int> spokes = doubled_spokes(sides);
  if (spokes[0] % 2 != 0) return {};
  for (int& spoke : spokes) spoke /= 2;
  const bool fits = *std::min_element(spokes.begin(), spokes.end() - 1) >= 1 && spokes.back() >= least_last;
  return fits ? spokes : std::vector<int>{};
}

int star_quads(const std::vector<int>& spokes) {
  int quads = 0;
  for (std::size_t i = 0; i < spokes.size(); ++i) quads += spokes[i] * spokes[(i + 1) % spokes.size()];
  return quads;
}

/// A cut of a patch in two stars: from `at[0]` edges along side `side[0]` to `at[1]` edges along side `side[1]`.
struct Cut {
  std::array<int, 2> side, at;
  int length;
  int quads;     ///< of both stars
  int balance;   ///< shortest spoke
};

/// Side lengths of the part of a cut patch that the cut's begin and the sides after it bound; the cut comes last.
std::vector<int> part_lengths(const std::vector<int>& sides, const Cut& cut, int begin) {
  const int n = static_cast<int>(sides.size()), end = 1 - begin;
  std::vector<int> lengths{sides[cut.side[begin]] - cut.at[begin]};
  for (int i = (cut.side[begin] + 1) % n; i != cut.side[end]; i = (i + 1) % n) lengths.push_back(sides[i]);
  lengths.push_back(cut.at[end]);
  lengths.push_back(cut.length);
  return lengths;
}

class PatternBuilder {
 public:
  explicit PatternBuilder(const std::vector<int>& sides) {
    pattern_.vertex_count = std::accumulate(sides.begin(), sides.end(), 0);
    int v = 0;
    for (const int length : sides) {
      Path path;
      for (int i = 0; i <= length; ++i) path.push_back((v + i) % pattern_.vertex_count);
      border_.push_back(std::move(path));
      v += length;
    }
  }

  PatchPattern grid() {
    fill_grid(border_[0], border_[1], reversed(border_[2]), reversed(border_[3]));
    return pattern_;
  }

  /// \param turn  how far the grid's first corner lies along the border
  PatchPattern ring(int turn) {
    const Path outer(border_[0].begin(), border_[0].end() - 1);
    const int n = static_cast<int>(outer.size()), width = n / 4, height = n / 2 - width;
    Path inner;
    for (int i = 0; i < n; ++i) inner.push_back(pattern_.vertex_count++);
    const auto side = [&](int from, int length) {
      Path path;
      for (int i = 0; i <= length; ++i) path.push_back(inner[(from + i) % n]);
      return path;
    };
    fill_grid(side(0, width), side(width, height), reversed(side(width + height, width)), reversed(side(n - height, height)));
    for (int i = 0; i < n; ++i) {
      const int next = (i + 1) % n;
      pattern_.quads.push_back({outer[(i + turn) % n], outer[(next + turn) % n], inner[next], inner[i]});
    }
    pattern_.irregular = 4;
    return pattern_;
  }

  PatchPattern star(const std::vector<int>& spokes) {
    fill_star(border_, spokes);
    pattern_.irregular = 1;
    return pattern_;
  }

  PatchPattern two_stars(const Cut& cut) {
    Path line = new_path(border_[cut.side[1]][cut.at[1]], border_[cut.side[0]][cut.at[0]], cut.length);
    for (const int begin : {0, 1}) {
      const int n = static_cast<int>(border_.size()), end = 1 - begin;
      const Path &first = border_[cut.side[begin]], &last = border_[cut.side[end]];
      std::vector<Path> sides{Path(first.begin() + cut.at[begin], first.end())};
      for (int i = (cut.side[begin] + 1) % n; i != cut.side[end]; i = (i + 1) % n) sides.push_back(border_[i]);
      sides.emplace_back(last.begin(), last.begin() + cut.at[end] + 1);
      sides.push_back(begin == 0 ? line : reversed(line));
      std::vector<int> lengths;
      for (const Path& side : sides) lengths.push_back(static_cast<int>(side.size()) - 1);
      fill_star(sides, star_spokes(lengths, 0));
    }
    pattern_.irregular = 2;
    return pattern_;
  }

 private:
  static Path reversed(Path path) {
    std::reverse(path.begin(), path.end());
    return path;
  }

  Path new_path(int from, int to, int length) {
    if (length == 0) return {to};
    Path path{from};
    for (int i = 1; i < length; ++i) path.push_back(pattern_.vertex_count++);
    path.push_back(to);
    return path;
  }

  /// \param left, right  upwards  \param bottom, top  from left to right
  void fill_grid(const Path& bottom, const Path& right, const Path& top, const Path& left) {
    Path below = bottom;
    for (std::size_t row = 1; row < left.size(); ++row) {
      const Path above = row + 1 < left.size() ? new_path(left[row], right[row], static_cast<int>(bottom.size()) - 1) : top;
      for (std::size_t i = 0; i + 1 < below.size(); ++i)
        pattern_.quads.push_back({below[i], below[i + 1], above[i + 1], above[i]});
      below = above;
    }
  }

  void fill_star(const std::vector<Path>& sides, const std::vector<int>& spokes) {
    const int n = static_cast<int>(sides.size());
    const bool on_last = spokes.back() == 0;
    const Path& last = sides.back();
    const int middle = on_last ? last[spokes[n - 2]] : pattern_.vertex_count++;
    std::vector<Path> spoke(n);
    for (int i = 0; i < n; ++i) {
      if (on_last && i == 0)  // the two beside the one without length lie on the last side
        spoke[i] = reversed(Path(last.begin() + spokes[n - 2], last.end()));
      else if (on_last && i == n - 2)
        spoke[i] = Path(last.begin(), last.begin() + spokes[n - 2] + 1);
      else
        spoke[i] = new_path(sides[i][spokes[(i + n - 1) % n]], middle, spokes[i]);
    }
    for (int i = 0; i < n; ++i) {
      const int before = (i + n - 1) % n;
      const Path bottom(sides[i].begin(), sides[i].begin() + spokes[before] + 1);
      const Path left(sides[before].end() - 1 - spokes[i], sides[before].end());
      fill_grid(bottom, spoke[i], spoke[before], reversed(left));
    }
  }

  PatchPattern pattern_;
  std::vector<Path> border_;
};

struct Lengths {
  int least, most;
};

/// Leaves of the lengths of a star's last side those with which no spoke is too short: each grows or shrinks with it.
void keep_those_of_stars(std::vector<int> sides, Lengths& lengths) {
  sides.back() = 0;
  const std::vector<int> without = doubled_spokes(sides);
  sides.back() = 1;
  const std::vector<int> with_one = doubled_spokes(sides);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const int room = without[i] - (i + 1 < sides.size() ? 2 : 0);
    if (with_one[i] > without[i]) lengths.least = std::max(lengths.least, -room);
    else lengths.most = std::min(lengths.most, room);
  }
}

/// All cuts into two stars between a pair of sides.
void find_cuts(const std::vector<int>& sides, int first, int last, std::vector<Cut>& cuts) {
  const int longest = std::accumulate(sides.begin(), sides.end(), 0);
  Cut cut{{first, last}, {0, 0}, 0, 0, 0};
  for (cut.at[0] = 1; cut.at[0] < sides[first]; ++cut.at[0])
    for (cut.at[1] = 1; cut.at[1] < sides[last]; ++cut.at[1]) {
      std::array<std::vector<int>, 2> parts{part_lengths(sides, cut, 0), part_lengths(sides, cut, 1)};
      Lengths lengths{1, longest - 1};
      for (const std::vector<int>& part : parts) keep_those_of_stars(part, lengths);
      for (cut.length = lengths.least; cut.length <= lengths.most; ++cut.length) {
        for (std::vector<int>& part : parts) part.back() = cut.length;
        const std::vector<int> here = star_spokes(parts[0], 0), there = star_spokes(parts[1], 0);
        if (here.empty() || there.empty() || here.back() + there.back() == 0) continue;
        cut.quads = star_quads(here) + star_quads(there);
        cut.balance = std::min(*std::min_element(here.begin(), here.end()), *std::min_element(there.begin(), there.end()));
        cuts.push_back(cut);
      }
    }
}

std::vector<Cut> cuts_into_stars(const std::vector<int>& sides) {
  std::vector<Cut> cuts;
  const int n = static_cast<int>(sides.size());
  if (n == 2) find_cuts(sides, 0, 1, cuts);
  if (n == 4)
    for (int i = 0; i < 4; ++i) find_cuts(sides, i, (i + 1) % 4, cuts);
  if (n == 6)
    for (int i = 0; i < 3; ++i) find_cuts(sides, i, i + 3, cuts);
  return cuts;
}

}  // namespace

std::vector<PatchPattern> patch_patterns(const std::vector<int>& sides, int quads_wanted, std::size_t most) {
  const int n = static_cast<int>(sides.size());
  if (n < 2 || n > 6 || std::accumulate(sides.begin(), sides.end(), 0) % 2 != 0) return {};
  if (n == 4 && sides[0] == sides[2] && sides[1] == sides[3]) return {PatternBuilder(sides).grid()};
  if (n % 2 != 0) {
    const std::vector<int> spokes = star_spokes(sides);
    if (spokes.empty()) return {};
    return {PatternBuilder(sides).star(spokes)};
  }
  std::vector<Cut> cuts = cuts_into_stars(sides);
  std::stable_sort(cuts.begin(), cuts.end(), [&](const Cut& x, const Cut& y) {
    const int off_x = std::abs(x.quads - quads_wanted), off_y = std::abs(y.quads - quads_wanted);
    return off_x != off_y ? off_x < off_y : x.balance > y.balance;
  });
  std::vector<PatchPattern> patterns;
  for (std::size_t i = 0; i < std::min(most, cuts.size()); ++i) patterns.push_back(PatternBuilder(sides).two_stars(cuts[i]));
  return patterns;
}

std::vector<PatchPattern> round_patterns(int edges, std::size_t most) {
  std::vector<PatchPattern> patterns;
  if (edges % 2 != 0 || edges < 4) return patterns;
  const int turns = std::min(edges / 2, static_cast<int>(most));
  for (int turn = 0; turn < turns; ++turn) patterns.push_back(PatternBuilder({edges}).ring(turn));
  return patterns;
}

}  // namespace hybrid_quad
