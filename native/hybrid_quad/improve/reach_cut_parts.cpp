#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/point_pulls.h"
#include "hybrid_quad/improve/quad_set.h"
#include "hybrid_quad/improve/shape_descent.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/smoothing_options.h"

namespace hybrid_quad {

namespace {

/// In edge lengths: near enough, and farther from the quads than bends as tight as quads can follow.
constexpr double kNear = 0.1, kFar = 0.5;
constexpr double kWeight = 30;  ///< of a pull

/// A point of the input and where the quads are nearest to it.
struct Witness {
  Vector3 point;
  int quad;
  double distance;  ///< in edges of that quad
};

double mean_edge(const EditMesh::Quad& v, const std::vector<Vector3>& positions) {
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += (positions[v[i]] - positions[v[(i + 1) & 3]]).norm();
  return sum / 4;
}

double edge_of(const EditMesh& mesh, int q) { return mean_edge(mesh.quad(q), mesh.positions); }

/// Of points from quads, in edge lengths.
struct Distances {
  double largest = 0;
  double excess = 0;  ///< squares of what is more than near, summed
};

/// \param edge  a length (scene units) to tell distances in
Distances distances_of(const std::vector<Vector3>& points, const QuadSet& quads, double edge) {
  Distances out;
  for (const Vector3& p : points) {
    const double distance = quads.nearest(p).distance / edge;
    out.largest = std::max(out.largest, distance);
    out.excess += std::pow(std::max(0.0, distance - kNear), 2);
  }
  return out;
}

class Reaching {
 public:
  Reaching(Workpiece& piece, const FlawMeasure& measure, const ImproveOptions& options, std::vector<Witness> witnesses, int threads)
      : piece_(piece), measure_(measure), witnesses_(std::move(witnesses)), smoother_(piece, smoothing_with_pulls(options, threads)) {
    of_quad_.resize(piece.mesh.quad_count());
    for (int i = 0; i < static_cast<int>(witnesses_.size()); ++i) of_quad_[witnesses_[i].quad].push_back(i);
  }

  int run(const RunContext& context) {
    constexpr double kApart = 1.5;
    constexpr int kLeastEffort = 20000, kEffort = 10;  // moves of vertices, and for every vertex of the mesh
    std::vector<int> far;
    for (int i = 0; i < static_cast<int>(witnesses_.size()); ++i)
      if (witnesses_[i].distance > kFar) far.push_back(i);
    std::stable_sort(far.begin(), far.end(), [&](int a, int b) { return witnesses_[a].distance > witnesses_[b].distance; });
    long long effort = kLeastEffort + static_cast<long long>(kEffort) * piece_.mesh.vertex_count();
    int reached = 0;
    std::vector<std::pair<Vector3, double>> done;
    for (const int i : far) {
      const Witness& target = witnesses_[i];
      const bool is_done = std::any_of(done.begin(), done.end(), [&](const auto& d) { return (d.first - target.point).norm() < d.second; });
      if (is_done) continue;
      if (effort <= 0) break;
      context.checkpoint();
      done.emplace_back(target.point, kApart * edge_of(piece_.mesh, target.quad));
      reached += reach(target, effort);
    }
    return reached;
  }

 private:
  /// A place where the quads are to reach farther, as it was and is.
  struct Site {
    const Witness& target;
    double edge;
    std::vector<int> vertices, quads;
    std::vector<Vector3> points;
    Distances before;
    Shapes shapes;
  };
  using Pulling = void (Reaching::*)(const Site&);

  SmootherOptions smoothing_with_pulls(const ImproveOptions& options, int threads) {
    SmootherOptions smoothing = smoothing_of(options, threads);
    smoothing.points = &pulls_;
    return smoothing;
  }

  /// Points that were nearest to some quads: of those that were far, and of the others, some.
  std::vector<Vector3> points_at(const std::vector<int>& quads) const {
    constexpr int kSome = 100;
    std::vector<int> far, others;
    for (const int q : quads)
      for (const int i : of_quad_[q]) (witnesses_[i].distance > kFar ? far : others).push_back(i);
    std::vector<Vector3> points;
    for (std::vector<int>* list : {&far, &others}) {
      std::sort(list->begin(), list->end());
      const std::size_t step = 1 + list->size() / kSome;
      for (std::size_t i = 0; i < list->size(); i += step) points.push_back(witnesses_[(*list)[i]].point);
    }
    return points;
  }

  /// Pulls towards the points that are a bit away, of each quad together as strong as one.
  void pull_quads(const Site& site) {
    const std::vector<int>& quads = site.quads;
    const QuadSet set(piece_.mesh, quads);
    std::vector<std::pair<int, PointPulls::Pull>> pulls;
    std::vector<int> count(quads.size(), 0);
    for (const Vector3& p : site.points) {
      const QuadSet::Place place = set.nearest(p);
      if (place.distance < kNear * edge_of(piece_.mesh, place.quad)) continue;
      const int i = static_cast<int>(std::lower_bound(quads.begin(), quads.end(), place.quad) - quads.begin());
      pulls.emplace_back(i, pull_of_quad(piece_.mesh, place, p, kWeight));
      ++count[i];
    }
    pulls_.clear();
    for (auto& [i, pull] : pulls) {
      pull.weight /= count[i];
      pulls_.add(pull);
    }
  }

  /// One corner goes ahead of the others: the way onto a tip in the middle of a quad, whose corners else hold each other back.
  void pull_corner(const Site& site) {
    const EditMesh::Quad& corners = piece_.mesh.quad(site.target.quad);
    const auto squared = [&](int v) { return (piece_.mesh.positions[v] - site.target.point).squaredNorm(); };
    PointPulls::Pull pull;
    pull.point = site.target.point;
    pull.vertices = corners;
    const auto nearest = std::min_element(corners.begin(), corners.end(), [&](int a, int b) { return squared(a) < squared(b); });
    pull.shares[nearest - corners.begin()] = 1;
    pull.weight = kWeight;
    pulls_.clear();
    pulls_.add(pull);
  }

  /// \returns how far the quads are from the points then; as before where they have no shapes to be kept
  Distances relaxed(const Site& site, Pulling pull, long long& effort) {
    constexpr int kSteps = 8, kStepsToTell = 2, kSweeps = 2;
    constexpr double kEps = 1e-3, kGain = 0.8, kGainToTell = 0.97;
    Distances now = site.before;
    for (int step = 0; step < kSteps && (step != kStepsToTell || now.excess < kGainToTell * site.before.excess); ++step) {
      (this->*pull)(site);
      smoother_.relax(site.vertices, kSweeps, kEps);
      effort -= kSweeps * static_cast<int>(site.vertices.size());
      if (step + 1 == kStepsToTell || step + 1 == kSteps) now = distances_of(site.points, QuadSet(piece_.mesh, site.quads), site.edge);
    }
    if (now.largest > site.before.largest || now.excess > kGain * site.before.excess) return site.before;
    return shapes_of(piece_.mesh, site.quads, measure_).are_kept_since(site.shapes) ? now : site.before;
  }

  std::vector<VertexPlace> places_of(const std::vector<int>& vertices) const {
    std::vector<VertexPlace> places;
    for (const int v : vertices) places.push_back(piece_.place_of(v));
    return places;
  }

  bool reach(const Witness& target, long long& effort) {
    constexpr int kLeastRings = 3, kMostRings = 6;
    constexpr double kMuch = 0.3;
    Site site{target, edge_of(piece_.mesh, target.quad), {}, {}, {}, {}, {}};
    const EditMesh::Quad& at = piece_.mesh.quad(target.quad);
    std::vector<int>& vertices = site.vertices;
    vertices.assign(at.begin(), at.end());
    const int rings = std::min(kMostRings, kLeastRings + static_cast<int>(target.distance));
    for (int ring = 1; ring < rings; ++ring) vertices = with_ring(piece_.mesh, vertices);
    vertices.erase(std::remove_if(vertices.begin(), vertices.end(), [&](int v) { return !piece_.may_move(v); }), vertices.end());
    if (vertices.empty()) return false;
    site.quads = quads_at(piece_.mesh, vertices);
    site.points = points_at(site.quads);
    const QuadSet untouched(piece_.mesh, site.quads);
    if (untouched.nearest(target.point).distance < kFar * site.edge) return false;  // reached along with another
    site.before = distances_of(site.points, untouched, site.edge);
    site.shapes = shapes_of(piece_.mesh, site.quads, measure_);
    const std::vector<VertexPlace> old = places_of(vertices);
    std::vector<VertexPlace> best = old;
    double least = site.before.excess;
    for (const Pulling pull : {&Reaching::pull_quads, &Reaching::pull_corner}) {
      const double excess = relaxed(site, pull, effort).excess;
      if (excess < least) {
        least = excess;
        best = places_of(vertices);
      }
      if (excess < kMuch * site.before.excess) return true;
      for (std::size_t i = 0; i < vertices.size(); ++i) piece_.put(vertices[i], old[i]);
      smoother_.update_frames(site.quads, true);
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) piece_.put(vertices[i], best[i]);
    smoother_.update_frames(site.quads, true);
    return least < site.before.excess;
  }

  Workpiece& piece_;
  const FlawMeasure& measure_;
  std::vector<Witness> witnesses_;
  std::vector<std::vector<int>> of_quad_;  ///< witnesses nearest to it
  PointPulls pulls_;
  Smoother smoother_;
};

}  // namespace

int reach_cut_parts(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                    const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole) {
  if (quads.quads.empty()) return 0;
  std::vector<Vector3> points(input.vertex_count());
  for (int v = 0; v < input.vertex_count(); ++v) points[v] = input.position(v);
  const std::vector<SurfacePoint> nearest = nearest_on_quads(points, quads, context);
  std::vector<double> edge;
  for (const auto& quad : quads.quads) edge.push_back(mean_edge(quad, quads.positions));
  std::vector<Witness> witnesses;
  bool any = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int quad = nearest[i].face;
    if (quad < 0) continue;
    witnesses.push_back({points[i], quad, std::sqrt(nearest[i].squared_distance) / edge[quad]});
    any = any || witnesses.back().distance > kFar;
  }
  if (!any) return 0;
  Workpiece piece(quads, input, features, index);
  if (options.target_length > 0) piece.h = options.target_length;
  if (!(piece.h > 0)) return 0;
  piece.locate_all(context);
  const FlawMeasure measure(piece, whole ? *whole : index, options.agreement, &options.least_agreement);
  const int reached = Reaching(piece, measure, options, std::move(witnesses), context.threads).run(context);
  if (reached > 0) quads = piece.mesh.extract(piece.face);
  return reached;
}

}  // namespace hybrid_quad
