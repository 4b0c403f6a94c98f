#include "hybrid_quad/improve/improve.h"

#include <algorithm>
#include <utility>

#include "hybrid_quad/improve/crowding.h"
#include "hybrid_quad/improve/fit.h"
#include "hybrid_quad/improve/improvement_attempts.h"
#include "hybrid_quad/improve/mend.h"
#include "hybrid_quad/improve/quad_number.h"
#include "hybrid_quad/improve/requadrangulate.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/smoothing_options.h"
#include "hybrid_quad/improve/spread_along_bends.h"
#include "hybrid_quad/improve/tip_pulls.h"
#include "hybrid_quad/improve/untangle.h"
#include "hybrid_quad/improve/valence_moves.h"
#include "hybrid_quad/improve/wedge_template.h"
#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

/// Connectivity in rounds: quads that crowd go, the rest is smoothed a little, then moves lower the valence cost. Fewer
/// irregular vertices let more crowded quads go in the next round. \returns number of moves
int edit_connectivity(Workpiece& piece, Smoother& smoother, const RunContext& context) {
  constexpr int kRounds = 4, kSweeps = 5;
  int moves = 0;
  SequenceMemory at_features, at_irregular;
  for (int round = 0; round < kRounds; ++round) {
    const int removed = remove_crowded(piece, context);
    if (round > 0 && removed == 0) break;
    moves += removed;
    spread_crowded(piece, context);
    smoother.smooth(kSweeps, context);
    moves += straighten_features(piece, smoother, at_features, context);
    moves += open_straight_corners(piece, smoother, context);
    moves += improve_valences(piece, smoother, at_irregular, context);
    moves += requadrangulate_patches(piece, smoother, context);
  }
  return moves;
}

Workpiece workpiece_of(const QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                       const ImproveOptions& options) {
  Workpiece piece(quads, input, features, index);
  if (options.target_length > 0) piece.h = options.target_length;
  return piece;
}

void bind(Workpiece& piece, const RunContext& context) {
  constexpr double kCurvatureWeight = 20;
  piece.bind_all(context);
  for (CurveGeometry& curve : piece.curves) curve.weigh_by_curvature(piece.h, kCurvatureWeight);
}

/// One round of everything; quads in `locked` stay as they are.
/// \param released  tips that hold nothing
Improved improve_around(const QuadMesh& quads, const std::vector<char>& locked, const std::vector<Vector3>& released, const TriangleMesh& input,
                      const FeatureGraph& features, const SurfaceIndex& index, const SurfaceIndex& whole,
                      const ImproveOptions& options, const RunContext& context) {
  Improved improved{quads, {}, {}, {}};
  ImproveReport& report = improved.report;
  constexpr int kSweepsAfter = 6, kLastRounds = 3;
  // Where many are inverted, and a round leaves more than such a part of them, another hardly helps; few are worth all rounds.
  constexpr int kManyInverted = 30;
  constexpr double kWorthwhile = 0.8;
  Workpiece piece = workpiece_of(quads, input, features, index, options);
  if (!(piece.h > 0)) return improved;
  for (int q = 0; q < piece.mesh.quad_count(); ++q)
    if (locked[q]) piece.mesh.lock(q);
  bind(piece, context);
  TipPulls tips(piece, released);
  improved.tips = tips.points();
  SmootherOptions smoothing = smoothing_of(options, context.threads);
  if (!tips.empty()) smoothing.tips = &tips;
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
  if (options.rings == nullptr) spread_along_bends(piece, smoother, context);
  if (options.fit) fit_to_input(piece, smoother, context);
  const FutileMending nowhere(piece.h);
  FutileUntangling futile{nowhere, nowhere, nowhere, nowhere};
  report.inverted_after = untangle(piece, smoother, context, futile);
  // What relaxing alone can't untangle may come free with other neighbours.
  for (int round = 0; round < kLastRounds && report.inverted_after > 0 && options.edit_connectivity; ++round) {
    const int moves = improve_shapes(piece, smoother, context);
    if (moves == 0) break;
    report.connectivity_moves += moves;
    const int before = report.inverted_after;
    report.inverted_after = untangle(piece, smoother, context, futile);
    if (report.inverted_after > kManyInverted && report.inverted_after > kWorthwhile * before) break;
  }
  if (options.rings == nullptr) {
    const MendReport mended = mend_flawed(piece, smoother, whole, options.agreement, context);
    report.mended = mended.mended;
    report.placed = mended.placed;
  }
  improved.quads = piece.mesh.extract(piece.face);
  return improved;
}

ImprovementAttempts attempts_at(const QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                                const ImproveOptions& options, const RunContext& context, const SurfaceIndex& judged) {
  return {quads, index, judged, options.agreement, context, [&](const std::vector<char>& locked, const std::vector<Vector3>& released) {
            return improve_around(quads, locked, released, input, features, index, judged, options, context);
          }};
}

int flawed_in(const EditMesh& mesh, const FlawMeasure& measure) {
  int flawed = 0;
  for (int q = 0; q < mesh.quad_count(); ++q) flawed += mesh.alive(q) && measure.is_flawed(q);
  return flawed;
}

/// Smooths everything, unless that brings flaws.
void smooth_without_flaws(Workpiece& piece, Smoother& smoother, const FlawMeasure& measure, int sweeps,
                          const RunContext& context) {
  const int before = flawed_in(piece.mesh, measure);
  const std::vector<Vector3> positions = piece.mesh.positions;
  const std::vector<int> faces = piece.face;
  const std::vector<double> arcs = piece.arc;
  smoother.smooth(sweeps, context);
  if (flawed_in(piece.mesh, measure) <= before) return;
  piece.mesh.positions = positions;
  piece.face = faces;
  piece.arc = arcs;
  smoother.update_frames(true);
}

double area_of(const QuadMesh& m) {
  double sum = 0;
  for (const auto& q : m.quads)
    sum += 0.5 * (m.positions[q[2]] - m.positions[q[0]]).cross(m.positions[q[3]] - m.positions[q[1]]).norm();
  return sum;
}

}  // namespace

Improved improve_once(const QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                      const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole) {
  if (quads.quads.empty() || input.face_count() == 0) return {quads, {}, {}, {}};
  return attempts_at(quads, input, features, index, options, context, whole ? *whole : index).once();
}

ImproveReport improve_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                            const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole,
                            std::optional<Improved> first) {
  if (quads.quads.empty() || input.face_count() == 0) return {};
  ImprovementAttempts attempts = attempts_at(quads, input, features, index, options, context, whole ? *whole : index);
  Improved best = attempts.best(std::move(first));
  ImproveReport& report = best.report;
  // A few quads around something small may slip off it to one side, where they shrink to a point.
  constexpr double kLeastArea = 0.1;
  const bool has_slipped = area_of(best.quads) < kLeastArea * std::min(area_of(quads), input.total_area());
  if (has_slipped || (report.flawed_after > 0 && report.flawed_after > attempts.flawed_before())) {
    report.connectivity_moves = 0;
    report.flawed_after = attempts.flawed_before();
    report.restored_quads = static_cast<int>(quads.quads.size());
    return report;
  }
  quads = std::move(best.quads);
  return report;
}

int change_quad_number(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                       const ImproveOptions& options, const QuadNumber& number, const RunContext& context,
                       const SurfaceIndex* whole) {
  constexpr double kFarOff = 1.5;
  constexpr double kMostInOneGo = 0.25;  // of the quads: in between all are smoothed
  constexpr int kSweeps = 5;
  Workpiece piece = workpiece_of(quads, input, features, index, options);
  if (!(piece.h > 0)) return 0;
  bind(piece, context);
  Smoother smoother(piece, smoothing_of(options, context.threads));
  smoother.update_frames(true);
  const FlawMeasure measure(piece, whole ? *whole : index, options.agreement);
  const int before = piece.mesh.live_quads();
  for (int now = before, last = -1; now != number.wanted && now != last;) {
    last = now;
    const int step = std::max(1, static_cast<int>(kMostInOneGo * now));
    const QuadNumber next{std::clamp(number.wanted, now - step, now + step), number.lengths, now > kFarOff * number.wanted};
    take_out_quads(piece, smoother, measure, next, context);
    put_in_quads(piece, smoother, measure, next, context);
    now = piece.mesh.live_quads();
    smooth_without_flaws(piece, smoother, measure, kSweeps, context);
  }
  mend_flawed(piece, smoother, measure.surface(), options.agreement, context);
  quads = piece.mesh.extract(piece.face);
  return static_cast<int>(quads.quads.size()) - before;
}

}  // namespace hybrid_quad
