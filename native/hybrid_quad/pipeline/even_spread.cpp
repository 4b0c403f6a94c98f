#include "hybrid_quad/pipeline/even_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>

namespace hybrid_quad {

namespace {

/// Points by cells of a grid, whose cells are as wide as the largest distance of its points.
class Grid {
 public:
  explicit Grid(double width) : width_(width) {}

  void add(const Vector3& p, int point) { cells_[key(cell_of(p))].push_back(point); }

  /// Calls visit(point) for the points in the cells about p, until it returns true.
  template <class Visit>
  bool any_near(const Vector3& p, const Visit& visit) const {
    const Cell middle = cell_of(p);
    for (int i = 0; i < 27; ++i) {
      const auto found = cells_.find(key({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1}));
      if (found != cells_.end() && std::any_of(found->second.begin(), found->second.end(), visit)) return true;
    }
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell_of(const Vector3& p) const {
    Cell out{};
    for (int k = 0; k < 3; ++k) out[k] = static_cast<std::int64_t>(std::floor(p[k] / width_));
    return out;
  }
  /// Two cells may share one: what is visited is only farther away then.
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>(c[0]) * 73856093U ^ static_cast<std::uint64_t>(c[1]) * 19349663U ^
           static_cast<std::uint64_t>(c[2]) * 83492791U;
  }

  double width_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

}  // namespace

std::vector<int> evenly_spread(const std::vector<Vector3>& points, const std::vector<Vector3>& normals,
                               const std::vector<double>& distance) {
  std::map<int, Grid> grids;  // by the binary logarithm of their points' distances
  std::vector<int> chosen;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const auto is_near = [&](int other) {
      const double least = std::min(distance[i], distance[other]);
      return normals[i].dot(normals[other]) > 0 && (points[i] - points[other]).squaredNorm() < least * least;
    };
    const bool is_taken = std::any_of(grids.begin(), grids.end(),
                                      [&](const auto& each) { return each.second.any_near(points[i], is_near); });
    if (is_taken) continue;
    const int level = static_cast<int>(std::ceil(std::log2(distance[i])));
    grids.try_emplace(level, std::exp2(level)).first->second.add(points[i], i);
    chosen.push_back(i);
  }
  return chosen;
}

}  // namespace hybrid_quad
