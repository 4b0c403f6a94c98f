#include "hybrid_quad/improve/improve.h"

#include "hybrid_quad/improve/crowding.h"
#include "hybrid_quad/improve/fit.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/untangle.h"
#include "hybrid_quad/improve/valence_moves.h"
#include "hybrid_quad/improve/wedge_template.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

namespace {

/// Connectivity in rounds: quads that crowd go, the rest is smoothed a little, then moves lower the valence cost. Fewer
/// irregular vertices let more crowded quads go in the next round. \returns number of moves
int edit_connectivity(Workpiece& piece, Smoother& smoother, const RunContext& context) {
  constexpr int kRounds = 4, kSweeps = 5;
  int moves = 0;
  for (int round = 0; round < kRounds; ++round) {
    const int removed = remove_crowded(piece, context);
    if (round > 0 && removed == 0) break;
    moves += removed;
    spread_crowded(piece, context);
    smoother.smooth(kSweeps, context);
    moves += straighten_features(piece, smoother, context);
    moves += open_straight_corners(piece, smoother, context);
    moves += improve_valences(piece, smoother, context);
  }
  return moves;
}

}  // namespace

ImproveReport improve_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features,
                            const SurfaceIndex& index, const ImproveOptions& options, const RunContext& context) {
  ImproveReport report;
  if (quads.quads.empty() || input.face_count() == 0) return report;
  constexpr double kCurvatureWeight = 20;
  constexpr int kSweepsAfter = 6, kLastRounds = 3;
  Workpiece piece(quads, input, features, index);
  if (options.target_length > 0) piece.h = options.target_length;
  if (!(piece.h > 0)) return report;
  report.inverted_before = static_cast<int>(tangled_quads(piece).size());
  piece.bind_all();
  for (CurveGeometry& curve : piece.curves) curve.weigh_by_curvature(piece.h, kCurvatureWeight);
  SmootherOptions smoothing;
  smoothing.chord_spring = options.chord_spring;
  Smoother smoother(piece, smoothing);
  if (options.edit_connectivity)
    report.connectivity_moves = edit_connectivity(piece, smoother, context);
  else
    spread_crowded(piece, context);
  smoother.smooth(options.smoothing_sweeps, context);
  if (options.edit_connectivity) {
    const int moves = improve_shapes(piece, smoother, context);
    if (moves > 0) smoother.smooth(kSweepsAfter, context);
    report.connectivity_moves += moves;
  }
  if (options.fit) fit_to_input(piece, smoother, context);
  report.inverted_after = untangle(piece, smoother, context);
  // What relaxing alone can't untangle may come free with other neighbours.
  for (int round = 0; round < kLastRounds && report.inverted_after > 0 && options.edit_connectivity; ++round) {
    const int moves = improve_shapes(piece, smoother, context);
    if (moves == 0) break;
    report.connectivity_moves += moves;
    report.inverted_after = untangle(piece, smoother, context);
  }
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
