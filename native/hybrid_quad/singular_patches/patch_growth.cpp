#include "hybrid_quad/singular_patches/patch_growth.h"

#include <algorithm>
#include <array>
#include <utility>

namespace hybrid_quad {

namespace {

/// The piece across overlay half-edge k, unless a feature or the surface's boundary lies between.
int piece_across(const GridOverlay& overlay, int k) {
  const int o = overlay.opposite[k];
  return o < 0 || overlay.curve[k] >= 0 ? -1 : overlay.piece_of[o];
}

/// \returns how many
int give_up(RegularQuads& regular, const std::vector<char>& is_given_up) {
  std::vector<int> new_id(regular.side.size(), -1);
  std::vector<std::array<int, 4>> kept;
  for (std::size_t c = 0; c < regular.side.size(); ++c) {
    if (is_given_up[c]) continue;
    new_id[c] = static_cast<int>(kept.size());
    kept.push_back(regular.side[c]);
  }
  const int count = static_cast<int>(regular.side.size() - kept.size());
  if (count == 0) return 0;
  regular.side = std::move(kept);
  for (int& cell : regular.piece_cell)
    if (cell >= 0) cell = new_id[cell];
  return count;
}

/// Cells beside border loops of patches with fewer than four arcs.
std::vector<char> cells_at_short_loops(const RegularQuads& regular) {
  constexpr int kLeastArcs = 4;
  const GridOverlay& overlay = regular.overlay;
  const auto cell_across = [&](int k) {
    const int piece = piece_across(overlay, k);
    return piece < 0 ? -1 : regular.piece_cell[piece];
  };
  const auto is_border = [&](int k) { return piece_across(overlay, k) < 0 || cell_across(k) >= 0; };
  std::vector<char> out(regular.side.size(), 0), seen(overlay.origin.size(), 0);
  std::vector<int> loop;
  for (int seed = 0; seed < static_cast<int>(overlay.origin.size()); ++seed) {
    if (seen[seed] || regular.piece_cell[overlay.piece_of[seed]] >= 0 || !is_border(seed)) continue;
    loop.clear();
    int arcs = 0;
    for (int k = seed; !seen[k];) {
      seen[k] = 1;
      loop.push_back(k);
      arcs += overlay.vertices[overlay.origin[k]].grid_sign != 0;
      k = overlay.next(k);
      while (!is_border(k)) k = overlay.next(overlay.opposite[k]);
    }
    if (arcs >= kLeastArcs) continue;
    for (const int k : loop)
      if (cell_across(k) >= 0) out[cell_across(k)] = 1;
  }
  return out;
}

}  // namespace

std::vector<std::vector<int>> find_patches(const RegularQuads& regular) {
  const GridOverlay& overlay = regular.overlay;
  std::vector<std::vector<int>> patches;
  std::vector<char> seen(overlay.piece_count(), 0);
  for (int seed = 0; seed < overlay.piece_count(); ++seed) {
    if (seen[seed] || regular.piece_cell[seed] >= 0) continue;
    std::vector<int> members{seed};
    seen[seed] = 1;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (int k = overlay.piece_begin[members[i]]; k < overlay.piece_begin[members[i] + 1]; ++k) {
        const int neighbour = piece_across(overlay, k);
        if (neighbour < 0 || seen[neighbour] || regular.piece_cell[neighbour] >= 0) continue;
        seen[neighbour] = 1;
        members.push_back(neighbour);
      }
    }
    std::sort(members.begin(), members.end());
    patches.push_back(std::move(members));
  }
  return patches;
}

int grow_over_short_loops(RegularQuads& regular) {
  int total = 0;
  while (const int count = give_up(regular, cells_at_short_loops(regular))) total += count;
  return total;
}

int grow(RegularQuads& regular, const std::vector<std::vector<int>>& patches, const std::vector<int>& which) {
  const GridOverlay& overlay = regular.overlay;
  std::vector<char> is_given_up(regular.side.size(), 0);
  for (const int i : which)
    for (const int piece : patches[i])
      for (int k = overlay.piece_begin[piece]; k < overlay.piece_begin[piece + 1]; ++k) {
        const int neighbour = piece_across(overlay, k);
        if (neighbour >= 0 && regular.piece_cell[neighbour] >= 0) is_given_up[regular.piece_cell[neighbour]] = 1;
      }
  return give_up(regular, is_given_up);
}

}  // namespace hybrid_quad
