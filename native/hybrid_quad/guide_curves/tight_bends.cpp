#include <algorithm>
#include <cmath>

#include "hybrid_quad/guide_curves/guide_curves.h"

namespace hybrid_quad {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kTight = 45;        ///< degrees of turn that count
constexpr double kWindow = 0.4;      ///< edge lengths before and after, in which the curve turns
constexpr double kApart = 1.0;       ///< edge lengths between two bends, and from a bend to the curve's ends

struct Bend {
  double turn;
  int at;  ///< place in the curve
};

/// Angle between the chords to the points a window before and after point i.
double turn_at(const std::vector<Vector3>& points, const std::vector<double>& arc, bool closed, int i, double window) {
  const int last = static_cast<int>(points.size()) - 1;
  const auto reach = [&](int step) {
    int k = i;
    for (double walked = 0; walked < window;) {
      int next = k + step;
      if (next < 0 || next > last) {
        if (!closed) return -1;
        k = next < 0 ? last : 0;
        next = k + step;
      }
      walked += std::abs(arc[next] - arc[k]);
      k = next;
      if (k == i) return -1;
    }
    return k;
  };
  const int before = reach(-1), after = reach(1);
  if (before < 0 || after < 0) return 0;
  const Vector3 a = points[i] - points[before], b = points[after] - points[i];
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

}  // namespace

std::vector<int> tight_bends(const TriangleMesh& mesh, const FeatureGraph& features, const std::vector<char>& chosen,
                             double length) {
  std::vector<int> found;
  for (std::size_t c = 0; c < features.curves.size(); ++c) {
    if (!chosen[c]) continue;
    const FeatureCurve& curve = features.curves[c];
    std::vector<Vector3> points;
    std::vector<double> arc;
    for (const int v : curve.vertices) {
      arc.push_back(points.empty() ? 0.0 : arc.back() + (mesh.position(v) - points.back()).norm());
      points.push_back(mesh.position(v));
    }
    std::vector<Bend> bends;
    for (int i = 0; i + 1 < static_cast<int>(points.size()); ++i) {
      if (!curve.closed && std::min(arc[i], arc.back() - arc[i]) < kApart * length) continue;
      const double turn = turn_at(points, arc, curve.closed, i, kWindow * length);
      if (turn > kTight) bends.push_back({turn, i});
    }
    std::stable_sort(bends.begin(), bends.end(), [](const Bend& x, const Bend& y) { return x.turn > y.turn; });
    std::vector<double> taken;
    for (const Bend& bend : bends) {
      const bool is_free = std::all_of(taken.begin(), taken.end(), [&](double other) {
        double gap = std::abs(other - arc[bend.at]);
        if (curve.closed) gap = std::min(gap, arc.back() - gap);
        return gap >= kApart * length;
      });
      if (!is_free) continue;
      taken.push_back(arc[bend.at]);
      found.push_back(curve.vertices[bend.at]);
    }
  }
  return found;
}

}  // namespace hybrid_quad
