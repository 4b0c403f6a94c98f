#include <algorithm>
#include <array>
#include <cmath>

#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

/// Turns edges that guides cross, and slides them along the guides: where a guide bends within less than an edge, the right
/// angle is right only at one place.
class EdgeSquaring {
 public:
  EdgeSquaring(QuadMesh& quads, const std::vector<GuideEdge>& rings, const std::vector<GuideLine>& lines);
  void run();

 private:
  using Ends = std::array<Vector3, 2>;

  double cost(const GuideLine& line, const Ends& start, const Ends& ends) const;
  double shape_at(const GuideEdge& e) const;
  bool square(const GuideEdge& e, const Ends& start, double least_shape, double step);

  QuadMesh& quads_;
  const std::vector<GuideLine>& lines_;
  std::vector<GuideEdge> edges_;            // those whose ends are free, and of no other such edge
  std::vector<std::vector<int>> quads_at_;  // by vertex, of the ends
};

EdgeSquaring::EdgeSquaring(QuadMesh& quads, const std::vector<GuideEdge>& rings, const std::vector<GuideLine>& lines)
    : quads_(quads), lines_(lines), quads_at_(quads.positions.size()) {
  std::vector<int> count(quads.positions.size(), 0);
  for (const GuideEdge& e : rings)
    for (const int v : {e.a, e.b}) ++count[v];
  for (const GuideEdge& e : rings) {
    const bool is_free = quads.kind[e.a] == VertexKind::kFree && quads.kind[e.b] == VertexKind::kFree;
    if (is_free && count[e.a] == 1 && count[e.b] == 1 && !lines[e.guide].empty()) edges_.push_back(e);
  }
  for (int q = 0; q < static_cast<int>(quads.quads.size()); ++q)
    for (const int v : quads.quads[q])
      if (count[v] == 1) quads_at_[v].push_back(q);
}

/// The squared sine of what is missing to a right angle, and the squared distance of the middle, in edges.
double EdgeSquaring::cost(const GuideLine& line, const Ends& start, const Ends& ends) const {
  constexpr double kStay = 1e-3;
  const Vector3 edge = ends[1] - ends[0];
  const double square = (start[1] - start[0]).squaredNorm();
  const GuideLine::Place place = line.nearest(0.5 * (ends[0] + ends[1]));
  const double sine = edge.normalized().dot(place.along);
  const double moved = (ends[0] - start[0]).squaredNorm() + (ends[1] - start[1]).squaredNorm();
  return sine * sine + (place.distance * place.distance + kStay * moved) / square;
}

double EdgeSquaring::shape_at(const GuideEdge& e) const {
  double least = 1;
  for (const int v : {e.a, e.b})
    for (const int q : quads_at_[v]) {
      const auto& c = quads_.quads[q];
      const std::vector<Vector3>& p = quads_.positions;
      least = std::min(least, scaled_jacobian(p[c[0]], p[c[1]], p[c[2]], p[c[3]]));
    }
  return least;
}

bool EdgeSquaring::square(const GuideEdge& e, const Ends& start, double least_shape, double step) {
  constexpr double kReach = 0.5;  // of the edge
  const GuideLine& line = lines_[e.guide];
  const double length = (start[1] - start[0]).norm();
  for (const std::array<double, 2>& way : {std::array<double, 2>{1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
    const Ends kept{quads_.positions[e.a], quads_.positions[e.b]};
    const GuideLine::Place place = line.nearest(0.5 * (kept[0] + kept[1]));
    Ends ends;
    for (int i = 0; i < 2; ++i) ends[i] = kept[i] + way[i] * step * length * place.along;
    const Vector3 middle = 0.5 * (ends[0] + ends[1]), onto = line.nearest(middle).position - middle;
    for (Vector3& end : ends) end += onto;
    const bool is_near = (ends[0] - start[0]).norm() <= kReach * length && (ends[1] - start[1]).norm() <= kReach * length;
    if (!is_near || !(cost(line, start, ends) < cost(line, start, kept))) continue;
    quads_.positions[e.a] = ends[0];
    quads_.positions[e.b] = ends[1];
    if (shape_at(e) >= least_shape) return true;
    quads_.positions[e.a] = kept[0];
    quads_.positions[e.b] = kept[1];
  }
  return false;
}

void EdgeSquaring::run() {
  constexpr double kLongest = 0.32, kShortest = 0.004;  // of the edge
  constexpr int kMostSteps = 12;
  constexpr double kShape = 0.35;
  for (const GuideEdge& e : edges_) {
    const Ends start{quads_.positions[e.a], quads_.positions[e.b]};
    const double least_shape = std::min(kShape, shape_at(e));
    for (double step = kLongest; step > kShortest; step /= 2)
      for (int i = 0; i < kMostSteps && square(e, start, least_shape, step); ++i) {
      }
  }
}

void centre(QuadMesh& quads, const std::vector<GuideEdge>& rings, const std::vector<GuideLine>& lines) {
  constexpr double kMost = 0.2;  // of an edge
  std::vector<Vector3> sum(quads.positions.size(), Vector3::Zero());
  std::vector<int> count(quads.positions.size(), 0);
  for (const GuideEdge& e : rings) {
    const Vector3 &a = quads.positions[e.a], &b = quads.positions[e.b], middle = 0.5 * (a + b);
    if (quads.kind[e.a] != VertexKind::kFree || quads.kind[e.b] != VertexKind::kFree || lines[e.guide].empty()) continue;
    Vector3 shift = lines[e.guide].nearest(middle).position - middle;
    const double most = kMost * (b - a).norm();
    if (shift.norm() > most) shift *= most / shift.norm();
    for (const int v : {e.a, e.b}) {
      sum[v] += shift;
      ++count[v];
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v)
    if (count[v] > 0) quads.positions[v] += sum[v] / count[v];
}

}  // namespace

void centre_on_guides(QuadMesh& quads, const std::vector<GuideEdge>& rings, const std::vector<StrokeTrace>& traces) {
  std::vector<GuideLine> lines;
  for (const StrokeTrace& trace : traces) lines.emplace_back(trace);
  centre(quads, rings, lines);
  EdgeSquaring(quads, rings, lines).run();
}

}  // namespace hybrid_quad
