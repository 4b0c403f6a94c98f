#include "hybrid_quad/guide_curves/guide_curves.h"

namespace hybrid_quad {

void centre_on_guides(QuadMesh& quads, const std::vector<GuideEdge>& rings, const std::vector<StrokeTrace>& traces) {
  constexpr double kMost = 0.2;  // of an edge
  std::vector<GuideLine> lines;
  for (const StrokeTrace& trace : traces) lines.emplace_back(trace);
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

}  // namespace hybrid_quad
