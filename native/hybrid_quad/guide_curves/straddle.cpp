#include <algorithm>
#include <limits>
#include <cmath>

#include "hybrid_quad/guide_curves/guide_curves.h"

namespace hybrid_quad {

namespace {

/// Points of a curve by arc length, and back.
class CurveArc {
 public:
  CurveArc(const FeatureCurve& curve, const TriangleMesh& input) : closed_(curve.closed) {
    for (const int v : curve.vertices) {
      const Vector3& p = input.position(v);
      start_.push_back(points_.empty() ? 0.0 : start_.back() + (p - points_.back()).norm());
      points_.push_back(p);
    }
  }
  double length() const { return start_.back(); }
  bool closed() const { return closed_; }

  double nearest(const Vector3& p) const {
    double best = 0, least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const Vector3 along = points_[i + 1] - points_[i];
      const double square = along.squaredNorm();
      const double t = square > 0 ? std::clamp(along.dot(p - points_[i]) / square, 0.0, 1.0) : 0.0;
      const double distance = (points_[i] + t * along - p).squaredNorm();
      if (distance < least) {
        least = distance;
        best = start_[i] + t * (start_[i + 1] - start_[i]);
      }
    }
    return best;
  }

  Vector3 at(double s) const {
    if (closed_) s -= length() * std::floor(s / length());
    const auto next = std::upper_bound(start_.begin() + 1, start_.end() - 1, s);
    const std::size_t i = static_cast<std::size_t>(next - start_.begin()) - 1;
    const double span = start_[i + 1] - start_[i];
    return points_[i] + (span > 0 ? (s - start_[i]) / span : 0.0) * (points_[i + 1] - points_[i]);
  }

 private:
  std::vector<Vector3> points_;
  std::vector<double> start_;
  bool closed_;
};

/// From the chord to the curve's farthest point between two places.
Vector3 sagitta(const CurveArc& curve, double from, double to) {
  constexpr int kSamples = 16;
  if (curve.closed() && to <= from) to += curve.length();
  const Vector3 a = curve.at(from), chord = curve.at(to) - a;
  Vector3 farthest = Vector3::Zero();
  if (!(to > from) || !(chord.squaredNorm() > 0)) return farthest;
  for (int i = 1; i < kSamples; ++i) {
    const Vector3 p = curve.at(from + (to - from) * i / kSamples) - a;
    const Vector3 away = p - std::clamp(p.dot(chord) / chord.squaredNorm(), 0.0, 1.0) * chord;
    if (away.squaredNorm() > farthest.squaredNorm()) farthest = away;
  }
  return farthest;
}

/// What a vertex between two edges is moved by: half of the larger sagitta halves the distance of both edges.
Vector3 shift_between(const Vector3& before, const Vector3& after) {
  if (before.dot(after) <= 0) return 0.25 * (before + after);
  return 0.5 * (before.squaredNorm() > after.squaredNorm() ? before : after);
}

}  // namespace

void straddle_curves(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const std::vector<char>& chosen) {
  constexpr double kMost = 0.15;  // of an edge
  const std::vector<QuadMesh::FeatureEdge>& edges = quads.feature_edges;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].curve == edges[begin].curve) ++end;
    if (!chosen[edges[begin].curve]) continue;
    const CurveArc curve(features.curves[edges[begin].curve], input);
    std::vector<double> arc;
    for (std::size_t i = begin; i < end; ++i) arc.push_back(curve.nearest(quads.positions[edges[i].a]));
    arc.push_back(curve.closed() ? arc.front() : curve.length());
    if (!curve.closed()) arc.front() = 0;
    std::vector<Vector3> away;
    for (std::size_t i = begin; i < end; ++i) away.push_back(sagitta(curve, arc[i - begin], arc[i - begin + 1]));
    std::vector<Vector3> moved;
    for (std::size_t i = begin; i < end; ++i) {
      const QuadMesh::FeatureEdge& e = edges[i];
      const QuadMesh::FeatureEdge& last = edges[i == begin ? end - 1 : i - 1];
      Vector3 shift = Vector3::Zero();
      if (quads.kind[e.a] == VertexKind::kCurve && last.b == e.a) {
        shift = shift_between(away[i == begin ? end - 1 - begin : i - 1 - begin], away[i - begin]);
        const double most = kMost * std::min((quads.positions[e.b] - quads.positions[e.a]).norm(),
                                             (quads.positions[last.b] - quads.positions[last.a]).norm());
        if (shift.norm() > most) shift *= most / shift.norm();
      }
      moved.push_back(quads.positions[e.a] + shift);
    }
    for (std::size_t i = begin; i < end; ++i) quads.positions[edges[i].a] = moved[i - begin];
  }
}

}  // namespace hybrid_quad
