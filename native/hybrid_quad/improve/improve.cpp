#include "hybrid_quad/improve/improve.h"

#include "hybrid_quad/improve/crowding.h"
#include "hybrid_quad/improve/fit.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/untangle.h"
#include "hybrid_quad/improve/valence_moves.h"
#include "hybrid_quad/improve/wedge_template.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

ImproveReport improve_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features,
                            const SurfaceIndex& index, const ImproveOptions& options, const RunContext& context) {
  ImproveReport report;
  if (quads.quads.empty() || input.face_count() == 0) return report;
  constexpr double kCurvatureWeight = 20;
  constexpr int kSweepsBefore = 5, kSweepsAfter = 6;
  Workpiece piece(quads, input, features, index);
  if (options.target_length > 0) piece.h = options.target_length;
  if (!(piece.h > 0)) return report;
  const int tangled_at_start = static_cast<int>(tangled_quads(piece).size());
  piece.bind_all();
  report.inverted_before = tangled_at_start;
  for (CurveGeometry& curve : piece.curves) curve.weigh_by_curvature(piece.h, kCurvatureWeight);
  if (options.edit_connectivity) report.connectivity_moves += remove_crowded(piece, context);
  spread_crowded(piece, context);
  SmootherOptions smoothing;
  smoothing.chord_spring = options.chord_spring;
  Smoother smoother(piece, smoothing);
  if (options.edit_connectivity) {
    smoother.smooth(kSweepsBefore, context);
    report.connectivity_moves += straighten_features(piece, smoother, context);
    report.connectivity_moves += open_straight_corners(piece, smoother, context);
    report.connectivity_moves += improve_valences(piece, smoother, context);
  }
  smoother.smooth(options.smoothing_sweeps, context);
  if (options.edit_connectivity) {
    const int moves = improve_shapes(piece, smoother, context);
    if (moves > 0) smoother.smooth(kSweepsAfter, context);
    report.connectivity_moves += moves;
  }
  if (options.fit) fit_to_input(piece, smoother, context);
  report.inverted_after = untangle(piece, smoother, context);
  // Quads that were hopeless from the start can end up worse: then better leave them as they are.
  if (report.inverted_after > report.inverted_before) {
    report.inverted_after = report.inverted_before;
    report.connectivity_moves = 0;
    return report;
  }
  quads = piece.mesh.extract();
  return report;
}

}  // namespace hybrid_quad
