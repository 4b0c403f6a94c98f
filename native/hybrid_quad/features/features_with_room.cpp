#include "hybrid_quad/features/features_with_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <unordered_map>

namespace hybrid_quad {

namespace {

constexpr double kSamples = 4;       ///< a gap
constexpr double kLeastLine = 2;     ///< gaps; what is shorter goes
constexpr double kMostCovered = 0.5;
const double kStraightOn = std::cos(40 * 3.14159265358979323846 / 180);

/// Points in cubes as large as the distance that is asked for.
class NearbyPoints {
 public:
  explicit NearbyPoints(double distance) : distance_(distance) {}

  void add(const Vector3& p) { cells_[key(cell(p))].push_back(p); }

  bool any_near(const Vector3& p) const {
    const auto c = cell(p);
    for (std::int64_t x = c[0] - 1; x <= c[0] + 1; ++x)
      for (std::int64_t y = c[1] - 1; y <= c[1] + 1; ++y)
        for (std::int64_t z = c[2] - 1; z <= c[2] + 1; ++z) {
          const auto found = cells_.find(key({x, y, z}));
          if (found == cells_.end()) continue;
          for (const Vector3& q : found->second)
            if ((p - q).squaredNorm() < distance_ * distance_) return true;
        }
    return false;
  }

 private:
  std::array<std::int64_t, 3> cell(const Vector3& p) const {
    return {static_cast<std::int64_t>(std::floor(p[0] / distance_)), static_cast<std::int64_t>(std::floor(p[1] / distance_)),
            static_cast<std::int64_t>(std::floor(p[2] / distance_))};
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& c) {
    std::uint64_t hash = 1469598103934665603ull;  // FNV-1a over the three numbers; a clash only costs time
    for (const std::int64_t x : c) hash = (hash ^ static_cast<std::uint64_t>(x)) * 1099511628211ull;
    return hash;
  }

  double distance_;
  std::unordered_map<std::uint64_t, std::vector<Vector3>> cells_;
};

/// Curves one after the other, each going straight on from the one before.
struct Line {
  std::vector<Vector3> points;
  std::vector<int> curves;
  double length = 0;
  double strength = 0;  ///< length, weighed by the bend across it
};

class LineChoice {
 public:
  LineChoice(const TriangleMesh& mesh, const FeatureGraph& features, const std::vector<char>& is_kept, double gap, const RunContext& context)
      : mesh_(mesh), features_(features), context_(context), gap_(gap), taken_points_(gap), taken_(features.curves.size(), 0),
        kept_(features.curves.size(), 0), at_end_(features.curves.size(), std::array<int, 2>{-1, -1}),
        length_(features.curves.size(), 0), bend_(features.curves.size(), 0) {
    for (int h = 0; h < mesh.halfedge_count(); ++h) {
      const int c = features.halfedge_curve[h];
      if (c < 0) continue;
      if (is_kept[h] || mesh.is_boundary(h)) kept_[c] = 1;
      if (mesh.is_boundary(h) || mesh.opposite(h) < h) continue;
      length_[c] += mesh.edge_length(h);
      bend_[c] += mesh.edge_length(h) * bend_across(h);
    }
    join_straight_on();
  }

  std::vector<char> run() {
    std::vector<Line> lines = trace_lines();
    std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.strength > b.strength; });
    for (std::size_t c = 0; c < kept_.size(); ++c)
      if (kept_[c]) take({points_of(static_cast<int>(c), true), {static_cast<int>(c)}, 0, 0});
    for (const Line& line : lines)
      if (has_room(line)) take(line);
    drop_small_sets();
    std::vector<char> remains(mesh_.halfedge_count(), 0);
    for (int h = 0; h < mesh_.halfedge_count(); ++h) remains[h] = features_.halfedge_curve[h] >= 0 && taken_[features_.halfedge_curve[h]];
    return remains;
  }

 private:
  double bend_across(int h) const {
    const Vector3 a = mesh_.normal(h / 3), b = mesh_.normal(mesh_.opposite(h) / 3);
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }

  const std::vector<int>& vertices(int c) const { return features_.curves[c].vertices; }
  int node(int c, int end) const { return end == 0 ? vertices(c).front() : vertices(c).back(); }

  /// Away from the end, as seen from half a gap along the curve.
  Vector3 direction(int c, int end) const {
    const std::vector<int>& v = vertices(c);
    const Vector3 from = mesh_.position(node(c, end));
    Vector3 d = Vector3::Zero();
    for (std::size_t i = 1; i < v.size(); ++i) {
      d = mesh_.position(end == 0 ? v[i] : v[v.size() - 1 - i]) - from;
      if (d.norm() > 0.5 * gap_) break;
    }
    return d.norm() > 0 ? Vector3(d / d.norm()) : d;
  }

  /// At every node, pairs of curves that go straight on into each other, the straightest first.
  void join_straight_on() {
    std::map<int, std::vector<std::array<int, 2>>> ends;  // node: curve, end
    for (int c = 0; c < static_cast<int>(taken_.size()); ++c)
      if (!features_.curves[c].closed)
        for (int end = 0; end < 2; ++end) ends[node(c, end)].push_back({c, end});
    for (const auto& [v, here] : ends) {
      std::vector<std::pair<double, std::array<std::size_t, 2>>> pairs;
      for (std::size_t i = 0; i < here.size(); ++i)
        for (std::size_t j = i + 1; j < here.size(); ++j) {
          const double cosine = -direction(here[i][0], here[i][1]).dot(direction(here[j][0], here[j][1]));
          if (cosine > kStraightOn) pairs.push_back({-cosine, {i, j}});
        }
      std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
      for (const auto& [cosine, ij] : pairs) {
        const auto &a = here[ij[0]], &b = here[ij[1]];
        if (at_end_[a[0]][a[1]] >= 0 || at_end_[b[0]][b[1]] >= 0) continue;
        at_end_[a[0]][a[1]] = 2 * b[0] + b[1];
        at_end_[b[0]][b[1]] = 2 * a[0] + a[1];
      }
    }
  }

  std::vector<Vector3> points_of(int c, bool forward) const {
    std::vector<Vector3> points;
    for (const int v : vertices(c)) points.push_back(mesh_.position(v));
    if (!forward) std::reverse(points.begin(), points.end());
    return points;
  }

  std::vector<Line> trace_lines() const {
    std::vector<Line> lines;
    std::vector<char> seen(taken_.size(), 0);
    for (int seed = 0; seed < static_cast<int>(taken_.size()); ++seed) {
      if (seen[seed] || kept_[seed]) continue;
      // Back to where the line begins, or once around.
      int first = 2 * seed;  // curve and the end at which it is entered
      for (int at = first, next; (next = at_end_[at / 2][at & 1]) >= 0 && !kept_[next / 2];) {
        at = next ^ 1;
        if (at / 2 == seed) break;
        first = at;
      }
      Line line;
      for (int at = first; at >= 0 && !seen[at / 2] && !kept_[at / 2]; at = at_end_[at / 2][(at & 1) ^ 1]) {
        seen[at / 2] = 1;
        line.curves.push_back(at / 2);
        const std::vector<Vector3> points = points_of(at / 2, (at & 1) == 0);
        line.points.insert(line.points.end(), points.begin() + (line.points.empty() ? 0 : 1), points.end());
        line.length += length_[at / 2];
        line.strength += bend_[at / 2];
      }
      lines.push_back(std::move(line));
    }
    return lines;
  }

  /// Calls visit(point, arc length) for points along a line, not farther apart than a part of a gap.
  template <class Visit>
  void sample(const std::vector<Vector3>& points, Visit visit) const {
    double arc = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const double length = (points[i + 1] - points[i]).norm();
      const int parts = std::max(1, static_cast<int>(std::ceil(kSamples * length / gap_)));
      for (int k = 0; k < parts; ++k) {
        constexpr int kSamplesAPoll = 1 << 14;
        if (++samples_ % kSamplesAPoll == 0) context_.checkpoint();
        const double t = (k + 0.5) / parts;
        visit((1 - t) * points[i] + t * points[i + 1], arc + t * length, length / parts);
      }
      arc += length;
    }
  }

  bool has_room(const Line& line) const {
    if (line.length < kLeastLine * gap_) return false;
    double covered = 0, all = 0;
    sample(line.points, [&](const Vector3& p, double arc, double weight) {
      if (arc < gap_ || line.length - arc < gap_) return;  // it may begin and end on another
      all += weight;
      if (taken_points_.any_near(p)) covered += weight;
    });
    return covered <= kMostCovered * all;
  }

  void take(const Line& line) {
    for (const int c : line.curves) taken_[c] = 1;
    sample(line.points, [&](const Vector3& p, double, double) { taken_points_.add(p); });
  }

  /// Connected features that are together not long enough to go around a quad.
  void drop_small_sets() {
    constexpr double kLeastSet = 4;  // gaps
    std::vector<int> parent(mesh_.vertex_count());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
      while (parent[v] != v) v = parent[v] = parent[parent[v]];
      return v;
    };
    for (std::size_t c = 0; c < taken_.size(); ++c)
      if (taken_[c])
        for (const int v : vertices(static_cast<int>(c))) parent[root(v)] = root(vertices(static_cast<int>(c)).front());
    std::map<int, double> length;
    std::map<int, char> kept;
    for (std::size_t c = 0; c < taken_.size(); ++c)
      if (taken_[c]) {
        const int r = root(vertices(static_cast<int>(c)).front());
        length[r] += length_[c];
        kept[r] = static_cast<char>(kept[r] | kept_[c]);
      }
    for (std::size_t c = 0; c < taken_.size(); ++c)
      if (taken_[c]) {
        const int r = root(vertices(static_cast<int>(c)).front());
        if (!kept[r] && length[r] < kLeastSet * gap_) taken_[c] = 0;
      }
  }

  const TriangleMesh& mesh_;
  const FeatureGraph& features_;
  const RunContext& context_;
  double gap_;
  NearbyPoints taken_points_;
  std::vector<char> taken_, kept_;           // by curve
  std::vector<std::array<int, 2>> at_end_;   // by curve and end: 2 curve + end that it goes straight on into, -1: none
  std::vector<double> length_, bend_;        // by curve
  mutable long long samples_ = 0;            // taken so far
};

}  // namespace

std::vector<char> features_with_room(const TriangleMesh& mesh, const FeatureGraph& features, const std::vector<char>& is_kept,
                                     double gap, const RunContext& context) {
  context.checkpoint();
  return LineChoice(mesh, features, is_kept, gap, context).run();
}

}  // namespace hybrid_quad
