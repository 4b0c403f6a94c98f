#include "hybrid_quad/sizing/curl_correction.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/grid_algebra/quarter_turn.h"
#include "hybrid_quad/sizing/edge_multipliers.h"
#include "hybrid_quad/sizing/vertex_potentials.h"

namespace hybrid_quad {

namespace {

/// The feature edges of face f stay isolines: at most one a row, the longest, or the row would have to vanish.
void choose_features(const FrameField& field, const WorkingSurface& surface, int f, CorrectionCosts& costs) {
  constexpr double kMostSlanted = 0.6;  // sine of the angle beyond which an edge follows no axis of the frame
  std::array<double, 2> longest{0, 0};
  for (int h = 3 * f; h < 3 * f + 3; ++h) {
    if (!surface.features.is_feature(h) && !surface.mesh.is_boundary(h)) continue;
    const Vector2 d = field.grid_vector(surface.mesh, h);
    const int row = std::abs(d[0]) >= std::abs(d[1]) ? 1 : 0;
    const double length = d.norm();
    if (length <= longest[row] || std::abs(d[row]) > kMostSlanted * length) continue;
    longest[row] = length;
    costs.feature[2 * f + row] = h;
  }
}

CorrectionCosts costs_of(const WorkingSurface& surface, const FrameField& field, const CurlCorrectionOptions& options) {
  const TriangleMesh& mesh = surface.mesh;
  const int faces = mesh.face_count();
  CorrectionCosts costs;
  costs.feature_weight = options.feature_weight * options.feature_weight;
  costs.stiffness.resize(2 * faces);
  costs.feature.assign(2 * faces, -1);
  costs.area.resize(faces);
  double total = 0;
  for (int f = 0; f < faces; ++f) total += costs.area[f] = mesh.area(f);
  const double mean = total > 0 ? total / faces : 1;
  for (int f = 0; f < faces; ++f) {
    costs.area[f] /= mean;
    const double share = costs.area[f] + 1e-4;  // a face without area still resists
    const double turning = options.direction_weight.empty() ? 2.0 : 2 * options.direction_weight[f];
    costs.stiffness[2 * f] = Vector2(1, turning) * share;
    costs.stiffness[2 * f + 1] = Vector2(turning, 1) * share;
    choose_features(field, surface, f, costs);
  }
  return costs;
}

/// Puts feature edges on their isolines exactly.
void align_with_features(const TriangleMesh& mesh, const FrameField& field, const CorrectionCosts& costs,
                         std::vector<std::array<double, 4>>& x) {
  for (std::size_t node = 0; node < costs.feature.size(); ++node) {
    if (costs.feature[node] < 0) continue;
    const Vector2 d = field.grid_vector(mesh, costs.feature[node]);
    if (!(d.squaredNorm() > 0)) continue;
    double* row = &x[node / 2][node % 2 == 0 ? 0 : 2];
    const double across = (row[0] * d[0] + row[1] * d[1]) / d.squaredNorm();
    row[0] -= across * d[0];
    row[1] -= across * d[1];
  }
}

/// Makes folded faces and their neighbours stiffer. \return false if too few are folded to matter
bool raise_around_folds(const TriangleMesh& mesh, const std::vector<std::array<double, 4>>& x, double tolerated, CorrectionCosts& costs) {
  constexpr double kRaise = 10;
  std::vector<char> marked(x.size(), 0);
  int folded = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (is_sound_correction(x[f])) continue;
    ++folded;
    marked[f] = 1;
    for (int h = 3 * f; h < 3 * f + 3; ++h)
      if (!mesh.is_boundary(h)) marked[mesh.opposite(h) / 3] = 1;
  }
  if (folded <= tolerated * mesh.face_count()) return false;
  for (int f = 0; f < mesh.face_count(); ++f)
    if (marked[f]) {
      costs.stiffness[2 * f] *= kRaise;
      costs.stiffness[2 * f + 1] *= kRaise;
    }
  return true;
}

/// Solves with `solver`, once more where too much is folded.
template <class Solver>
void correct(const WorkingSurface& surface, const FrameField& field, const CurlCorrectionOptions& options, CorrectionCosts costs,
             std::vector<std::array<double, 4>>& x, const RunContext& context) {
  Solver solver(surface.mesh, field, costs);
  for (int round = 0;; ++round) {
    context.checkpoint(0.1);
    solver.solve(costs, options.curl_weight, x, context);
    align_with_features(surface.mesh, field, costs, x);
    if (round == options.max_raises || !raise_around_folds(surface.mesh, x, options.tolerated_folds, costs)) break;
  }
}

}  // namespace

bool is_sound_correction(const std::array<double, 4>& x) {
  constexpr double kLeastDeterminant = 0.2, kMostDeviation = 3;
  const double deviation = (x[0] - 1) * (x[0] - 1) + x[1] * x[1] + x[2] * x[2] + (x[3] - 1) * (x[3] - 1);
  return x[0] * x[3] - x[1] * x[2] > kLeastDeterminant && deviation < kMostDeviation * kMostDeviation;
}

std::vector<std::array<double, 4>> curl_correction(const WorkingSurface& surface, const FrameField& field,
                                                   const CurlCorrectionOptions& options, const RunContext& context) {
  std::vector<std::array<double, 4>> x(surface.mesh.face_count(), {1, 0, 0, 1});
  const CorrectionCosts costs = costs_of(surface, field, options);
  if (options.curl_weight <= kMostForPotentials) correct<VertexPotentials>(surface, field, options, costs, x, context);
  else correct<EdgeMultipliers>(surface, field, options, costs, x, context);
  return x;
}

double curl_of(const TriangleMesh& mesh, const FrameField& field) {
  double mismatch = 0, length = 0;
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o < h) continue;
    const Vector2 here = field.grid_vector(mesh, h), there = turned(field.grid_vector(mesh, o), field.matching[o]);
    mismatch += (here + there).squaredNorm();
    length += here.squaredNorm();
  }
  return length > 0 ? std::sqrt(mismatch / length) : 0;
}

}  // namespace hybrid_quad
