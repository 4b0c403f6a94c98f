#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/mesh/segment_index.h"

namespace hybrid_quad {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

/// In how many pieces a set of edges falls, edges being given by their ends.
int piece_count(const std::vector<std::array<int, 2>>& edges) {
  std::map<int, int> parent;
  const auto root = [&](int v) {
    while (parent.emplace(v, v).first->second != v) v = parent[v];
    return v;
  };
  for (const auto& [a, b] : edges) parent[root(a)] = root(b);
  int pieces = 0;
  for (const auto& [v, p] : parent) pieces += v == p;
  return pieces;
}

std::vector<GuideEdge> of_guide(const std::vector<GuideEdge>& edges, int guide) {
  std::vector<GuideEdge> own;
  for (const GuideEdge& e : edges)
    if (e.guide == guide) own.push_back(e);
  return own;
}

double mean_length(const std::vector<GuideEdge>& edges, const QuadMesh& quads) {
  double sum = 0;
  for (const GuideEdge& e : edges) sum += (quads.positions[e.b] - quads.positions[e.a]).norm();
  return sum / static_cast<double>(edges.size());
}

/// Which pairs of edges are opposite sides of a quad. \param mean_side  gets the mean length of the sides of these quads
std::vector<std::array<int, 2>> linked_by_quads(const std::vector<GuideEdge>& edges, const QuadMesh& quads, double& mean_side) {
  std::map<std::array<int, 2>, int> number;
  for (std::size_t i = 0; i < edges.size(); ++i)
    number[{std::min(edges[i].a, edges[i].b), std::max(edges[i].a, edges[i].b)}] = static_cast<int>(i);
  const auto at = [&](int a, int b) {
    const auto found = number.find({std::min(a, b), std::max(a, b)});
    return found == number.end() ? -1 : found->second;
  };
  std::vector<std::array<int, 2>> links;
  double sum = 0;
  for (const auto& q : quads.quads)
    for (int side = 0; side < 2; ++side) {
      const int i = at(q[side], q[side + 1]), k = at(q[side + 2], q[(side + 3) & 3]);
      if (i < 0 || k < 0) continue;
      links.push_back({i, k});
      for (int j = 0; j < 4; ++j) sum += 0.25 * (quads.positions[q[(j + 1) & 3]] - quads.positions[q[j]]).norm();
    }
  if (!links.empty()) mean_side = sum / static_cast<double>(links.size());
  return links;
}

}  // namespace

GuideFit measure_loop(const StrokeTrace& trace, const QuadMesh& quads, const std::vector<GuideEdge>& chains, int guide) {
  GuideFit fit;
  fit.length = GuideLine(trace).length();
  const std::vector<GuideEdge> own = of_guide(chains, guide);
  if (own.empty() || !(fit.length > 0)) return fit;
  std::vector<std::array<Vector3, 2>> segments;
  std::vector<std::array<int, 2>> ends;
  for (const GuideEdge& e : own) {
    segments.push_back({quads.positions[e.a], quads.positions[e.b]});
    ends.push_back({e.a, e.b});
  }
  const SegmentIndex index(std::move(segments));
  double farthest = 0;
  for (const StrokeTrace::Run& run : trace.runs)
    for (const SurfacePoint& p : run.samples) farthest = std::max(farthest, std::sqrt(index.nearest(p.position).squared_distance));
  fit.edges = static_cast<int>(own.size());
  fit.edge_length = mean_length(own, quads);
  fit.distance = farthest / fit.edge_length;
  fit.is_connected = piece_count(ends) <= static_cast<int>(trace.runs.size());
  return fit;
}

GuideFit measure_ring(const StrokeTrace& trace, const QuadMesh& quads, const std::vector<GuideEdge>& rings, int guide) {
  GuideFit fit;
  const GuideLine line(trace);
  fit.length = line.length();
  const std::vector<GuideEdge> own = of_guide(rings, guide);
  if (own.empty() || line.empty()) return fit;
  double farthest = 0;
  for (const GuideEdge& e : own) {
    const Vector3 a = quads.positions[e.a], b = quads.positions[e.b];
    const GuideLine::Place place = line.nearest(0.5 * (a + b));
    farthest = std::max(farthest, place.distance);
    const double sine = std::abs((b - a).normalized().dot(place.along));
    fit.angle = std::max(fit.angle, std::asin(std::min(1.0, sine)) / kDegree);
  }
  fit.edges = static_cast<int>(own.size());
  fit.edge_length = mean_length(own, quads);
  const std::vector<std::array<int, 2>> links = linked_by_quads(own, quads, fit.edge_length);
  fit.distance = farthest / fit.edge_length;
  std::vector<char> is_linked(own.size(), 0);
  for (const auto& [i, k] : links) is_linked[i] = is_linked[k] = 1;
  fit.is_connected = std::count(is_linked.begin(), is_linked.end(), 0) == 0 &&
                     piece_count(links) <= static_cast<int>(trace.runs.size());
  return fit;
}

}  // namespace hybrid_quad
