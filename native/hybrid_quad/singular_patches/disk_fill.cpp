#include "hybrid_quad/singular_patches/disk_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hybrid_quad {

namespace {

/// One way to fill what a chord (i, j) cuts off: a piece next to the chord whose other sides are chords or
/// border sides.
struct Choice {
  double cost = std::numeric_limits<double>::infinity();
  std::vector<int> chain;  ///< the piece's corners from i to j
  int star = -1;           ///< parity of the corners joined to an inner vertex, -1 for a single quad
};

class PolygonFiller {
 public:
  explicit PolygonFiller(const BorderPolygon& polygon)
      : polygon_(polygon), count_(static_cast<int>(polygon.positions.size())), best_(count_ * count_) {}

  DiskFill run() {
    for (int length = 3; length < count_; length += 2)
      for (int i = 0; i + length < count_; ++i) {
        chain_.assign(1, i);
        extend(i, i + length, 0);
      }
    DiskFill fill;
    fill.positions = polygon_.positions;
    fill.cost = best(0, count_ - 1).cost;
    emit(0, count_ - 1, fill);
    return fill;
  }

 private:
  Choice& best(int i, int j) { return best_[i * count_ + j]; }

  /// Tries all chains that start with chain_ and end at j by steps of odd length.
  void extend(int i, int j, double below) {
    const int at = chain_.back();
    if (at == j) {
      consider(i, j, below);
      return;
    }
    if (chain_.size() >= 10) return;
    for (int to = at + 1; to <= j; to += 2) {
      if (at == i && to == j) continue;
      chain_.push_back(to);
      extend(i, j, below + (to - at > 1 ? best(at, to).cost : 0));
      chain_.pop_back();
    }
  }

  void consider(int i, int j, double below) {
    Choice& choice = best(i, j);
    if (below >= choice.cost) return;
    const int corners = static_cast<int>(chain_.size());
    if (corners == 4) {
      const double cost = below + quad_cost(chain_[0], chain_[1], chain_[2], chain_[3]);
      if (cost < choice.cost) choice = {cost, chain_, -1};
      return;
    }
    const Vector3 center = center_of(chain_);
    Vector3 normal = Vector3::Zero();
    for (const int v : chain_) normal += polygon_.normals[v];
    for (int parity = 0; parity < 2; ++parity) {
      double cost = below + 0.3 * std::abs(corners / 2 - 4);
      for (int s = parity; s < corners + parity; s += 2)
        cost += star_quad_cost(center, normal, chain_[s % corners], chain_[(s + 1) % corners],
                               chain_[(s + 2) % corners]);
      if (cost < choice.cost) choice = {cost, chain_, parity};
    }
  }

  Vector3 center_of(const std::vector<int>& chain) const {
    Vector3 sum = Vector3::Zero();
    for (const int v : chain) sum += polygon_.positions[v];
    return sum / static_cast<double>(chain.size());
  }

  static double corner_cost(const Vector3& before, const Vector3& at, const Vector3& after,
                            const Vector3& normal) {
    const Vector3 a = after - at, b = before - at;
    const double length = normal.norm() * std::sqrt(a.squaredNorm() * b.squaredNorm());
    if (!(length > 0)) return 4;
    double angle = std::atan2(normal.dot(a.cross(b)) / length, a.dot(b) * normal.norm() / length);
    if (angle < 0) angle += 2 * M_PI;
    const double off = angle / (M_PI / 2) - 1;
    return off * off + (angle > 0.95 * M_PI ? 4 : 0);
  }

  double size_cost(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) const {
    const double wanted = polygon_.target_length * polygon_.target_length,
                 area = 0.5 * (c - a).cross(d - b).norm();
    const double ratio = std::log(std::max(area, 1e-3 * wanted) / wanted);
    return wanted > 0 ? 0.3 * ratio * ratio : 0;
  }

  double quad_cost(int a, int b, int c, int d) const {
    const int v[4] = {a, b, c, d};
    const auto& p = polygon_.positions;
    double cost = size_cost(p[a], p[b], p[c], p[d]);
    for (int i = 0; i < 4; ++i)
      cost += corner_cost(p[v[(i + 3) & 3]], p[v[i]], p[v[(i + 1) & 3]], polygon_.normals[v[i]]);
    return cost;
  }

  double star_quad_cost(const Vector3& center, const Vector3& normal, int a, int b, int c) const {
    const auto& p = polygon_.positions;
    return size_cost(center, p[a], p[b], p[c]) + corner_cost(p[c], center, p[a], normal) +
           corner_cost(center, p[a], p[b], polygon_.normals[a]) +
           corner_cost(p[a], p[b], p[c], polygon_.normals[b]) +
           corner_cost(p[b], p[c], center, polygon_.normals[c]);
  }

  void emit(int i, int j, DiskFill& fill) {
    const Choice choice = best(i, j);
    const auto& chain = choice.chain;
    const int corners = static_cast<int>(chain.size());
    if (choice.star < 0) {
      fill.quads.push_back({chain[0], chain[1], chain[2], chain[3]});
    } else {
      const int center = static_cast<int>(fill.positions.size());
      fill.positions.push_back(center_of(chain));
      for (int s = choice.star; s < corners + choice.star; s += 2)
        fill.quads.push_back(
            {center, chain[s % corners], chain[(s + 1) % corners], chain[(s + 2) % corners]});
    }
    for (int k = 0; k + 1 < corners; ++k)
      if (chain[k + 1] - chain[k] > 1) emit(chain[k], chain[k + 1], fill);
  }

  const BorderPolygon& polygon_;
  int count_;
  std::vector<Choice> best_;
  std::vector<int> chain_;
};

}  // namespace

DiskFill fill_disk(const BorderPolygon& polygon) { return PolygonFiller(polygon).run(); }

}  // namespace hybrid_quad
