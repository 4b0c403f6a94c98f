#pragma once

#include <array>
#include <map>
#include <vector>

#include "hybrid_quad/mesh/quad_mesh.h"

namespace hybrid_quad {

/// Quads by their directed sides.
class QuadSides {
 public:
  explicit QuadSides(const QuadMesh& mesh) : mesh_(mesh), corner_(mesh.positions.size(), -1) {
    for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
      for (int i = 0; i < 4; ++i) {
        side_[{mesh.quads[q][i], mesh.quads[q][(i + 1) & 3]}] = 4 * q + i;
        corner_[mesh.quads[q][i]] = 4 * q + i;
      }
  }

  /// The side (dart 4 q + i) from a to b, or -1.
  int at(int a, int b) const {
    const auto found = side_.find({a, b});
    return found == side_.end() ? -1 : found->second;
  }
  int from(int d) const { return mesh_.quads[d / 4][d & 3]; }
  int to(int d) const { return mesh_.quads[d / 4][(d + 1) & 3]; }
  static int previous(int d) { return (d & ~3) | ((d + 3) & 3); }
  static int next(int d) { return (d & ~3) | ((d + 1) & 3); }
  int opposite(int d) const { return at(to(d), from(d)); }
  /// Darts that leave v counterclockwise, from the boundary if v is on it.
  std::vector<int> fan(int v) const {
    int first = corner_[v];
    for (int d = first; opposite(d) >= 0;) {
      d = next(opposite(d));
      if (d == corner_[v]) break;
      first = d;
    }
    if (opposite(first) >= 0) first = corner_[v];
    std::vector<int> darts;
    for (int d = first; d >= 0;) {
      darts.push_back(d);
      d = opposite(previous(d));
      if (d == first) break;
    }
    return darts;
  }
  bool on_boundary(int v) const { return opposite(fan(v).front()) < 0; }

 private:
  const QuadMesh& mesh_;
  std::map<std::array<int, 2>, int> side_;
  std::vector<int> corner_;
};

}  // namespace hybrid_quad
