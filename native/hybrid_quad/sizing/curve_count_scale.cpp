#include "hybrid_quad/sizing/curve_count_scale.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/sizing/cotangent.h"

namespace hybrid_quad {

namespace {

constexpr double kReach = 3;      ///< quads within which a factor fades to 1/e
constexpr double kPinned = 1e6;   ///< over the Laplacian's diagonal: next to the given values nothing else counts

}  // namespace

CurveCountScale::CurveCountScale(const WorkingSurface& surface) : surface_(surface) {
  const auto& curves = surface.features.curves;
  idle_ = std::none_of(curves.begin(), curves.end(), [](const FeatureCurve& c) { return c.asked_count > 0; });
  if (idle_) return;
  const TriangleMesh& mesh = surface.mesh;
  const int n = mesh.vertex_count();
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> diagonal(n, 1e-12);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const double weight = std::max(0.5 * cotangent(mesh, h), 5e-3);
    const int p = mesh.from(h), q = mesh.to(h);
    entries.emplace_back(std::max(p, q), std::min(p, q), -weight);
    diagonal[p] += weight;
    diagonal[q] += weight;
  }
  for (int f = 0; f < mesh.face_count(); ++f) {
    const double reach = kReach * surface.target_length[f];
    for (const int v : mesh.face(f)) diagonal[v] += mesh.area(f) / (3 * reach * reach);
  }
  pin_weight_.assign(n, 0);
  for (const FeatureCurve& curve : curves)
    if (curve.asked_count > 0)
      for (const int v : curve.vertices) pin_weight_[v] = kPinned * diagonal[v];
  for (int v = 0; v < n; ++v) entries.emplace_back(v, v, diagonal[v] + pin_weight_[v]);
  matrix_.resize(n, n);
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

/// By curve: logarithm of the factor on what its edges measure, 0 where nothing is asked.
std::vector<double> CurveCountScale::log_factors(const FrameField& field) const {
  const TriangleMesh& mesh = surface_.mesh;
  const FeatureGraph& features = surface_.features;
  std::vector<double> measured(features.curves.size(), 0.0);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (!features.is_feature(h)) continue;
    const double own = field.grid_vector(mesh, h).norm();
    measured[features.halfedge_curve[h]] += mesh.is_boundary(h) ? own : 0.5 * own;
  }
  std::vector<double> factor(measured.size(), 0.0);
  for (std::size_t c = 0; c < factor.size(); ++c)
    if (features.curves[c].asked_count > 0 && measured[c] > 0) factor[c] = std::log(features.curves[c].asked_count / measured[c]);
  return factor;
}

void CurveCountScale::apply(FrameField& field, const RunContext& context) const {
  if (idle_) return;
  const TriangleMesh& mesh = surface_.mesh;
  const std::vector<double> factor = log_factors(field);
  std::vector<double> sum(mesh.vertex_count(), 0), count(mesh.vertex_count(), 0);
  for (std::size_t c = 0; c < factor.size(); ++c) {
    const FeatureCurve& curve = surface_.features.curves[c];
    if (curve.asked_count <= 0) continue;
    for (const int v : curve.vertices) {
      sum[v] += factor[c];
      count[v] += 1;
    }
  }
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (count[v] > 0) right_side[v] = pin_weight_[v] * sum[v] / count[v];
  const Eigen::VectorXd log_factor = solve_sparse(matrix_, right_side, mesh.positions(), context);
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto& t = mesh.face(f);
    const double scale = std::exp((log_factor[t[0]] + log_factor[t[1]] + log_factor[t[2]]) / 3);
    if (!std::isfinite(scale) || !(scale > 0)) continue;
    field.du[f] *= scale;
    field.dv[f] *= scale;
  }
}

}  // namespace hybrid_quad
