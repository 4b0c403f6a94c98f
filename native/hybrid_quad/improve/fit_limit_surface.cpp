#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/limit_surface.h"
#include "hybrid_quad/numerics/sparse_factor.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;

constexpr std::array<double, 3> kFitted = {1.0 / 6, 0.5, 5.0 / 6};
constexpr std::array<double, 4> kMeasured = {0.125, 0.375, 0.625, 0.875};

/// What a point of the limit surface is for.
struct Sample {
  LimitPlace place;
  int curve = -1;           ///< to lie on this feature curve; -1: on the surface
  int side = -1;            ///< of the quad, where it is on a curve
  bool is_measured = false; ///< tells how far the limit surface is, and takes no part in the fit
};

std::vector<Sample> samples_of(const QuadMesh& mesh) {
  std::map<std::array<int, 2>, int> curve_of;
  for (const QuadMesh::FeatureEdge& e : mesh.feature_edges) curve_of[{std::min(e.a, e.b), std::max(e.a, e.b)}] = e.curve;
  std::vector<Sample> samples;
  for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q) {
    for (const double u : kFitted)
      for (const double v : kFitted) samples.push_back({{q, u, v}, -1, -1, false});
    for (const double u : kMeasured)
      for (const double v : kMeasured) samples.push_back({{q, u, v}, -1, -1, true});
    for (int side = 0; side < 4; ++side) {
      const int a = mesh.quads[q][side], b = mesh.quads[q][(side + 1) % 4];
      const auto found = curve_of.find({std::min(a, b), std::max(a, b)});
      if (found == curve_of.end()) continue;
      for (const double t : kFitted) samples.push_back({place_on_side(q, side, t), found->second, side, false});
      curve_of.erase(found);
    }
  }
  return samples;
}

/// The limit surface of a mesh whose vertices move, against the surface that it is to lie on.
class LimitFit {
 public:
  LimitFit(const QuadMesh& mesh, const SurfaceIndex& surface, const std::vector<SegmentIndex>& curves,
           const RunContext& context)
      : mesh_(mesh), surface_(surface), curves_(curves), context_(context), samples_(samples_of(mesh)) {
    std::vector<LimitPlace> places;
    for (const Sample& sample : samples_) places.push_back(sample.place);
    weights_ = limit_weights(mesh, places, context);
    size_.reserve(mesh.quads.size());
    for (const auto& v : mesh.quads) {
      double sum = 0;
      for (int i = 0; i < 4; ++i) sum += 0.25 * (mesh.positions[v[(i + 1) % 4]] - mesh.positions[v[i]]).norm();
      size_.push_back(sum);
    }
  }

  /// Displacements that bring the limit surface to the surface: projections of its points and linear least squares, in turn.
  Points solve() {
    constexpr int kRounds = 12;
    build_system();
    const int n = static_cast<int>(mesh_.positions.size());
    Points moves = Points::Zero(n, 3);
    if (unknown_.empty()) return moves;
    std::vector<Vector3> places;
    for (const int v : unknown_) places.push_back(mesh_.positions[v]);
    SparseFactor factor(system_, places, context_);
    if (!factor.factorize(system_, 0, context_)) return moves;
    const Points rest = weights_ * positions(Points::Zero(n, 3));
    for (int round = 0; round < kRounds; ++round) {
      context_.checkpoint(static_cast<double>(round) / kRounds);
      const Points asked = targets(weights_ * positions(moves), moves) - rest;
      const Points pull = weights_.transpose() * (fit_weight_.asDiagonal() * asked);
      for (int axis = 0; axis < 3; ++axis) {
        Eigen::VectorXd right(unknown_.size());
        for (std::size_t i = 0; i < unknown_.size(); ++i) right[i] = pull(unknown_[i], axis);
        const Eigen::VectorXd solution = factor.solve(right, context_.threads);
        for (std::size_t i = 0; i < unknown_.size(); ++i) moves(unknown_[i], axis) = solution[i];
      }
    }
    return moves;
  }

  /// Mean, by the quads' areas, and maximum of the limit surface's distance from the surface (scene units).
  DirectedDistance distance(const Points& moves) const {
    const Points at = weights_ * positions(moves);
    std::vector<double> away(samples_.size(), 0);
    over_samples([&](int i) {
      if (samples_[i].is_measured) away[i] = std::sqrt(surface_.nearest(at.row(i).transpose()).squared_distance);
    });
    DirectedDistance distance;
    double area = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!samples_[i].is_measured) continue;
      const auto& v = mesh_.quads[samples_[i].place.quad];
      const auto& p = mesh_.positions;
      const double weight = (p[v[2]] - p[v[0]]).cross(p[v[3]] - p[v[1]]).norm();
      distance.mean += weight * away[i];
      area += weight;
      distance.largest = std::max(distance.largest, away[i]);
    }
    if (area > 0) distance.mean /= area;
    return distance;
  }

 private:
  template <class Work>
  void over_samples(const Work& work) const {
    parallel_chunks(static_cast<int>(samples_.size()), context_, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) work(i);
    });
  }

  Points positions(const Points& moves) const {
    Points out(moves.rows(), 3);
    for (Eigen::Index v = 0; v < moves.rows(); ++v) out.row(v) = mesh_.positions[v].transpose() + moves.row(v);
    return out;
  }

  /// (L^T W L + lambda K) for the vertices that may move; K is the Laplacian of the quads' edges.
  void build_system() {
    constexpr double kOnCurves = 4, kStiffness = 0.01;
    const int n = static_cast<int>(mesh_.positions.size());
    fit_weight_.resize(static_cast<Eigen::Index>(samples_.size()));
    for (std::size_t i = 0; i < samples_.size(); ++i)
      fit_weight_[i] = samples_[i].is_measured ? 0 : samples_[i].curve >= 0 ? kOnCurves : 1;
    std::vector<int> number(n, -1);
    for (int v = 0; v < n; ++v)
      if (mesh_.kind[v] != VertexKind::kCorner) {
        number[v] = static_cast<int>(unknown_.size());
        unknown_.push_back(v);
      }
    const SparseMatrix normal = weights_.transpose() * (fit_weight_.asDiagonal() * weights_);
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int a, int b, double value) {
      if (number[a] >= 0 && number[b] >= 0 && number[a] >= number[b]) entries.emplace_back(number[a], number[b], value);
    };
    for (int v = 0; v < n; ++v)
      for (SparseMatrix::InnerIterator it(normal, v); it; ++it) add(static_cast<int>(it.row()), v, it.value());
    for (const auto& quad : mesh_.quads)
      for (int i = 0; i < 4; ++i) {
        const int a = quad[i], b = quad[(i + 1) % 4];
        add(a, a, kStiffness);
        add(b, b, kStiffness);
        add(a, b, -kStiffness);
        add(b, a, -kStiffness);
      }
    const int unknowns = static_cast<int>(unknown_.size());
    system_.resize(unknowns, unknowns);
    system_.setFromTriplets(entries.begin(), entries.end());
  }

  /// Where limit points should be: nearer to their curves, or to the surface where it looks along their quads. Only across
  /// their own edges and quads, or points would gather where curves and surfaces bend.
  Points targets(const Points& at, const Points& moves) const {
    constexpr double kFarthest = 0.7;  // of an edge: further away is another part of the surface
    constexpr double kStep = 1.5;  // points keep their places along the surface for a round, which slows them: ask for more
    const Points vertices = positions(moves);
    Points target = at;
    over_samples([&](int i) {
      const Sample& sample = samples_[i];
      if (sample.is_measured) return;
      const Vector3 p = at.row(i).transpose();
      const Vector3 way = sample.curve >= 0 ? way_to_curve(sample, p, vertices) : way_to_surface(sample, p, vertices);
      if (way.norm() <= kFarthest * size_[sample.place.quad]) target.row(i) += kStep * way.transpose();
    });
    return target;
  }

  Vector3 way_to_curve(const Sample& sample, const Vector3& p, const Points& vertices) const {
    const SegmentIndex& curve = curves_[sample.curve];
    const SegmentPoint near = curve.nearest(p);
    if (near.segment < 0) return Vector3::Zero();
    const Vector3 way = curve.position(near) - p;
    const auto& v = mesh_.quads[sample.place.quad];
    const Vector3 along = (vertices.row(v[(sample.side + 1) % 4]) - vertices.row(v[sample.side])).transpose().normalized();
    return way - along * along.dot(way);
  }

  Vector3 way_to_surface(const Sample& sample, const Vector3& p, const Points& vertices) const {
    constexpr double kAgrees = 0.2;
    const auto& v = mesh_.quads[sample.place.quad];
    const double a = sample.place.u, b = sample.place.v;
    const auto side = [&](int from, int to) { return Vector3((vertices.row(v[to]) - vertices.row(v[from])).transpose()); };
    const Vector3 along = (1 - b) * side(0, 1) + b * side(3, 2), across = (1 - a) * side(0, 3) + a * side(1, 2);
    SurfaceIndex::Filter filter;
    filter.normal = along.cross(across).normalized();
    filter.min_cosine = kAgrees;
    const SurfacePoint near = surface_.nearest(p, filter);
    return near.face < 0 ? Vector3::Zero() : Vector3(filter.normal * filter.normal.dot(near.position - p));
  }

  const QuadMesh& mesh_;
  const SurfaceIndex& surface_;
  const std::vector<SegmentIndex>& curves_;
  const RunContext& context_;
  std::vector<Sample> samples_;
  std::vector<double> size_;  ///< #Q: mean edge
  SparseMatrix weights_;      ///< #samples x #V
  Eigen::VectorXd fit_weight_;
  std::vector<int> unknown_;  ///< vertices that may move
  SparseMatrix system_;
};

/// Takes moves back, first half of them and then all, until no quad points against the surface or is worse shaped than it was
/// and should be. \returns number of vertices held back
int hold_back(const QuadMesh& mesh, const SurfaceIndex& surface, Points& moves, const RunContext& context) {
  constexpr double kGoodEnough = 0.3, kLoss = 0.02;
  constexpr int kHalvings = 4;
  const int quads = static_cast<int>(mesh.quads.size());
  const auto corners_of = [&](int q, bool moved) {
    std::array<Vector3, 4> corners;
    for (int i = 0; i < 4; ++i) {
      const int v = mesh.quads[q][i];
      corners[i] = mesh.positions[v];
      if (moved) corners[i] += moves.row(v).transpose();
    }
    return corners;
  };
  const auto shape_of = [](const std::array<Vector3, 4>& c) { return scaled_jacobian(c[0], c[1], c[2], c[3]); };
  std::vector<char> is_held(mesh.positions.size(), 0), is_bad(quads, 0);
  for (int round = 0;; ++round) {
    parallel_chunks(quads, context, [&](int begin, int end) {
      for (int q = begin; q < end; ++q) {
        const std::array<Vector3, 4> before = corners_of(q, false), now = corners_of(q, true);
        const double shape = shape_of(now);
        is_bad[q] = (shape < kGoodEnough && shape < shape_of(before) - kLoss) ||
                    (is_inverted(now, surface) && !is_inverted(before, surface));
      }
    });
    bool any = false;
    std::vector<char> is_next(mesh.positions.size(), 0);
    for (int q = 0; q < quads; ++q)
      if (is_bad[q])
        for (const int v : mesh.quads[q]) is_next[v] = !moves.row(v).isZero(0);
    for (std::size_t v = 0; v < is_next.size(); ++v) {
      if (!is_next[v]) continue;
      moves.row(static_cast<Eigen::Index>(v)) *= round < kHalvings ? 0.5 : 0.0;
      is_held[v] = 1;
      any = true;
    }
    if (!any) break;
  }
  return static_cast<int>(std::count(is_held.begin(), is_held.end(), 1));
}

}  // namespace

LimitFitReport fit_limit_surface(QuadMesh& quads, const SurfaceIndex& surface, const std::vector<SegmentIndex>& curves,
                                 const RunContext& context) {
  LimitFitReport report;
  if (quads.quads.empty()) return report;
  LimitFit fit(quads, surface, curves, context);
  report.before = fit.distance(Points::Zero(static_cast<Eigen::Index>(quads.positions.size()), 3));
  Points moves = fit.solve();
  report.held_back = hold_back(quads, surface, moves, context);
  report.after = fit.distance(moves);
  if (report.after.mean >= report.before.mean) {  // it was as near as it gets, as on flat surfaces
    report.after = report.before;
    report.held_back = static_cast<int>(quads.positions.size());
    return report;
  }
  for (std::size_t v = 0; v < quads.positions.size(); ++v)
    quads.positions[v] += moves.row(static_cast<Eigen::Index>(v)).transpose();
  return report;
}

}  // namespace hybrid_quad
