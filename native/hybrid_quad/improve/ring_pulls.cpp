#include "hybrid_quad/improve/ring_pulls.h"

#include <cmath>

namespace hybrid_quad {

namespace {

constexpr double kMiddleWeight = 200, kAngleWeight = 100;  ///< against the corners' shape, of squares in edge lengths

constexpr double kBeyond = 0.02;  ///< edge lengths

}  // namespace

RingPulls::RingPulls(const std::vector<GuideEdge>& edges, const std::vector<StrokeTrace>& traces, std::size_t vertex_count)
    : edges_(edges), edges_of_(vertex_count) {
  for (int i = 0; i < static_cast<int>(edges.size()); ++i) {
    edges_of_[edges[i].a].push_back(i);
    edges_of_[edges[i].b].push_back(i);
  }
  for (const StrokeTrace& trace : traces) lines_.emplace_back(trace);
}

void RingPulls::add_to(GuidePull& sum, int v, const std::vector<Vector3>& positions, const Vector3& normal, double size) const {
  for (const int i : edges_of_[v]) {
    const int other = edges_[i].a == v ? edges_[i].b : edges_[i].a;
    const Vector3 middle = 0.5 * (positions[v] + positions[other]), edge = positions[v] - positions[other];
    const GuideLine::Place place = lines_[edges_[i].guide].nearest(middle);
    const Vector3 beside = normal.cross(place.along).normalized();
    if (!beside.allFinite()) continue;
    sum.add(beside, (middle - place.position).dot(beside), 2, kMiddleWeight / (size * size));
    // Beyond the line's end.
    const double beyond = (middle - place.position).dot(place.along);
    if (std::abs(beyond) > kBeyond * size) sum.add(place.along, beyond, 2, kMiddleWeight / (size * size));
    sum.add(place.along, edge.dot(place.along), 1, kAngleWeight / (size * size));
  }
}

}  // namespace hybrid_quad
