#include <algorithm>
#include <utility>
#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/shape_descent.h"

namespace hybrid_quad {

int raise_shapes(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                 const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole, int* ended_searches,
                 FutileMending* futile) {
  constexpr double kPoor = 0.2;
  constexpr int kMostRings = 3;
  constexpr int kLeastEffort = 2000, kEffort = 4;  // vertices moved down, and for every vertex of the mesh
  std::vector<std::pair<double, int>> poor;
  for (int q = 0; q < static_cast<int>(quads.quads.size()); ++q) {
    const auto& v = quads.quads[q];
    const auto& p = quads.positions;
    if (const double shape = scaled_jacobian(p[v[0]], p[v[1]], p[v[2]], p[v[3]]); shape < kPoor) poor.emplace_back(shape, q);
  }
  if (poor.empty()) return 0;
  std::sort(poor.begin(), poor.end());
  Workpiece piece(quads, input, features, index);
  if (options.target_length > 0) piece.h = options.target_length;
  if (!(piece.h > 0)) return 0;
  piece.locate_all(context);
  const FlawMeasure measure(piece, whole ? *whole : index, options.agreement, &options.least_agreement);
  long long effort = kLeastEffort + static_cast<long long>(kEffort) * piece.mesh.vertex_count();
  int raised = 0;
  for (const auto& [shape, q] : poor) {
    if (measure.boxes_opened() > options.most_boxes_opened) {
      if (ended_searches) ++*ended_searches;
      break;
    }
    if (futile && futile->knows(piece, q)) continue;
    const int raised_before = raised;
    std::vector<int> around(piece.mesh.quad(q).begin(), piece.mesh.quad(q).end());
    for (int rings = 0; rings <= kMostRings && effort > 0 && shape_of(piece.mesh, q) < kPoor; ++rings) {
      context.checkpoint();
      if (rings > 0) around = with_ring(piece.mesh, around);
      ShapeDescent descent(piece, measure, around);
      effort -= descent.size();
      raised += descent.run(DescentPlan{});
    }
    if (futile && effort > 0 && raised == raised_before) futile->remember(piece, q);
  }
  if (raised > 0) quads = piece.mesh.extract(piece.face);
  return raised;
}

}  // namespace hybrid_quad
