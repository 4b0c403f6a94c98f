#include "hybrid_quad/pipeline/missed_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "hybrid_quad/mesh/segment_index.h"

namespace hybrid_quad {

namespace {

/// Edges of the plan's mesh along a loop guide.
std::vector<std::array<int, 2>> edges_of(const ComponentPlan& plan, const HardGuides& guides, int guide) {
  std::vector<std::array<int, 2>> edges;
  for (int h = 0; h < plan.mesh.halfedge_count(); ++h) {
    if (plan.guides[h] < 0 || plan.mesh.opposite(h) > h) continue;
    const std::vector<int>& along = guides.sets[plan.guides[h]].guides;
    if (std::find(along.begin(), along.end(), guide) != along.end()) edges.push_back({plan.mesh.from(h), plan.mesh.to(h)});
  }
  return edges;
}

std::set<int> loops_on(const ComponentPlan& plan, const HardGuides& guides) {
  std::set<int> loops;
  for (const int set : plan.guides)
    if (set >= 0 && guides.sets[set].is_loop) loops.insert(guides.sets[set].guides.begin(), guides.sets[set].guides.end());
  return loops;
}

bool has_corner_near(const ComponentPlan& plan, int v, double distance) {
  for (int w = 0; w < plan.mesh.vertex_count(); ++w)
    if (plan.features.is_corner[w] && (plan.mesh.position(w) - plan.mesh.position(v)).norm() < distance) return true;
  return false;
}

std::vector<std::array<Vector3, 2>> chain_along(const ComponentResult& result, int guide) {
  std::vector<std::array<Vector3, 2>> chain;
  for (const GuideEdge& e : result.chains)
    if (e.guide == guide) chain.push_back({result.mesh.positions[e.a], result.mesh.positions[e.b]});
  return chain;
}

double mean_length(const std::vector<std::array<Vector3, 2>>& segments) {
  double sum = 0;
  for (const auto& [a, b] : segments) sum += (b - a).norm();
  return sum / static_cast<double>(segments.size());
}

}  // namespace

MissedLoops missed_loops(const ComponentPlan& plan, const HardGuides& guides, const ComponentResult& result) {
  constexpr double kApart = 0.2;      // of an edge: corners nearer to each other would bring worse than they mend
  constexpr double kElsewhere = 0.5;  // edges from the component's part of the guide
  MissedLoops missed;
  for (const int guide : loops_on(plan, guides)) {
    const std::vector<std::array<Vector3, 2>> chain = chain_along(result, guide);
    if (chain.empty()) {
      missed.excess = std::numeric_limits<double>::infinity();
      continue;
    }
    const double length = mean_length(chain);
    const std::vector<std::array<int, 2>> edges = edges_of(plan, guides, guide);
    std::vector<std::array<Vector3, 2>> pieces;
    for (const auto& [a, b] : edges) pieces.push_back({plan.mesh.position(a), plan.mesh.position(b)});
    const SegmentIndex quads(chain), line(std::move(pieces));
    double most = GuideFit::kNear, most_apart = GuideFit::kNear;
    int place = -1;
    for (const StrokeTrace::Run& run : guides.traces[guide].runs)
      for (const SurfacePoint& sample : run.samples) {
        const double distance = std::sqrt(quads.nearest(sample.position).squared_distance) / length;
        if (distance <= most_apart) continue;
        const SegmentPoint near = line.nearest(sample.position);
        if (std::sqrt(near.squared_distance) > kElsewhere * length) continue;
        most = std::max(most, distance);
        const int v = edges[near.segment][near.fraction < 0.5 ? 0 : 1];
        if (has_corner_near(plan, v, kApart * length)) continue;
        most_apart = distance;
        place = v;
      }
    missed.excess += most - GuideFit::kNear;
    if (place >= 0) missed.places.push_back(place);
  }
  return missed;
}

}  // namespace hybrid_quad
