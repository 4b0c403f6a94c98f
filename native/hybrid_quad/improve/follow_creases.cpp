#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "hybrid_quad/improve/fit.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/nearest_side.h"
#include "hybrid_quad/improve/point_pulls.h"
#include "hybrid_quad/improve/shape_descent.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/smoothing_options.h"

namespace hybrid_quad {

namespace {

/// In edge lengths.
constexpr double kNear = 0.1;   ///< nearer a side need not be
constexpr double kFar = 0.15;   ///< farther, and it is brought nearer
constexpr double kApart = 0.1;  ///< points along creases

/// A point on a crease and the side that is nearest.
struct Witness {
  Vector3 point;
  SidePlace side;
};

/// Half-edges of the edges above an angle (degrees) that are no features.
std::vector<int> creases_of(const TriangleMesh& input, const FeatureGraph& features, double sharp_angle) {
  const double most_cosine = std::cos(sharp_angle * EIGEN_PI / 180);
  std::vector<int> creases;
  for (int h = 0; h < 3 * input.face_count(); ++h) {
    const int opposite = input.opposite(h);
    if (opposite < h || features.is_feature(h) || input.normal(h / 3).dot(input.normal(opposite / 3)) > most_cosine) continue;
    creases.push_back(h);
  }
  return creases;
}

/// Points along edges, each in the middle of a piece of about `step` or of a shorter edge; of longer pieces where these would be more than
/// `most`, as along needles that are much longer than the edges of quads.
std::vector<Vector3> points_on(const std::vector<int>& creases, const TriangleMesh& input, double step, double most) {
  const auto along = [&](int h) -> Vector3 { return input.position(input.to(h)) - input.position(input.from(h)); };
  double total = 0;
  for (const int h : creases) total += along(h).norm();
  step = std::max(step, total / most);
  std::vector<Vector3> points;
  for (const int h : creases) {
    const int count = std::max(1, static_cast<int>(std::lround(along(h).norm() / step)));
    for (int i = 0; i < count; ++i) points.push_back(input.position(input.from(h)) + (i + 0.5) / count * along(h));
  }
  return points;
}

/// \returns the points, each with the side nearest to it; where very many are over one quad, the farthest of them
std::vector<Witness> witnesses_of(const std::vector<Vector3>& points, const QuadMesh& quads, const EditMesh& mesh, const RunContext& context) {
  constexpr std::size_t kMostInQuad = 60;
  const std::vector<SurfacePoint> nearest = nearest_on_quads(points, quads, context);
  std::vector<std::vector<Witness>> of_quad(quads.quads.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const int quad = nearest[i].face; quad >= 0)
      of_quad[quad].push_back({points[i], nearest_side(mesh, points[i], mesh.quad(quad))});
  std::vector<Witness> witnesses;
  for (std::vector<Witness>& list : of_quad) {
    const auto is_farther = [](const Witness& a, const Witness& b) { return a.side.distance > b.side.distance; };
    if (list.size() > kMostInQuad) {
      std::stable_sort(list.begin(), list.end(), is_farther);
      list.resize(kMostInQuad);
    }
    witnesses.insert(witnesses.end(), list.begin(), list.end());
  }
  return witnesses;
}

/// Brings sides nearer to witnesses, place by place.
class Following {
 public:
  Following(Workpiece& piece, const FlawMeasure& measure, const ImproveOptions& options, std::vector<Witness> witnesses, int threads)
      : piece_(piece),
        measure_(measure),
        options_(options),
        witnesses_(std::move(witnesses)),
        of_quad_(piece.mesh.quad_count()),
        moved_(piece.mesh.vertex_count(), 0),
        smoother_(piece, smoothing_with_pulls(options, threads)) {}

  int run(const RunContext& context) {
    constexpr int kLeastEffort = 20000, kEffort = 30;  // moves of vertices, and for every vertex of the mesh
    constexpr int kRounds = 2;
    effort_ = kLeastEffort + static_cast<long long>(kEffort) * piece_.mesh.vertex_count();
    smoother_.update_frames(true);
    for (int q = 0; q < piece_.mesh.quad_count(); ++q) quality_.push_back(smoother_.signed_quality(q));
    int places = 0;
    for (int round = 0; round < kRounds; ++round) {
      const int more = follow_all(context);
      places += more;
      if (more == 0) break;
    }
    if (places > 0 && options_.fit) fit_to_input(piece_, smoother_, context, &moved_);
    return places;
  }

 private:
  /// A place where sides are to come nearer to creases.
  struct Site {
    std::vector<int> vertices, quads, witnesses;
    std::vector<VertexPlace> places;  ///< of the vertices, to be put back
    Shapes shapes;
  };
  struct Distances {
    double largest = 0;
    double excess = 0;  ///< squares of what is more than near, summed
  };

  SmootherOptions smoothing_with_pulls(const ImproveOptions& options, int threads) {
    SmootherOptions smoothing = smoothing_of(options, threads);
    smoothing.points = &pulls_;
    return smoothing;
  }

  double edges(double length) const { return length / piece_.h; }

  int follow_all(const RunContext& context) {
    for (auto& list : of_quad_) list.clear();
    std::vector<int> far;
    for (int i = 0; i < static_cast<int>(witnesses_.size()); ++i) {
      of_quad_[witnesses_[i].side.quad].push_back(i);
      if (edges(witnesses_[i].side.distance) > kFar) far.push_back(i);
    }
    const auto is_farther = [&](int a, int b) { return witnesses_[a].side.distance > witnesses_[b].side.distance; };
    std::stable_sort(far.begin(), far.end(), is_farther);
    std::vector<char> is_tried(piece_.mesh.quad_count(), 0);
    int places = 0;
    for (const int i : far) {
      const SidePlace& side = witnesses_[i].side;
      if (edges(side.distance) < kFar || is_tried[side.quad]) continue;  // brought nearer along with another, or not
      if (effort_ <= 0) break;
      context.checkpoint();
      is_tried[side.quad] = 1;
      places += follow(side.quad);
    }
    return places;
  }

  Site site_around(int quad) const {
    constexpr int kRings = 4;
    Site site;
    site.vertices.assign(piece_.mesh.quad(quad).begin(), piece_.mesh.quad(quad).end());
    for (int ring = 1; ring < kRings; ++ring) site.vertices = with_ring(piece_.mesh, site.vertices);
    const auto is_fixed = [&](int v) { return !piece_.mesh.is_free(v) || !piece_.may_move(v); };
    site.vertices.erase(std::remove_if(site.vertices.begin(), site.vertices.end(), is_fixed), site.vertices.end());
    site.quads = quads_at(piece_.mesh, site.vertices);
    for (const int q : site.quads) site.witnesses.insert(site.witnesses.end(), of_quad_[q].begin(), of_quad_[q].end());
    for (const int v : site.vertices) site.places.push_back(piece_.place_of(v));
    site.shapes = shapes_of(piece_.mesh, site.quads, measure_);
    return site;
  }

  void look_again(const Site& site) {
    for (const int i : site.witnesses) {
      const SidePlace& side = witnesses_[i].side;
      const EditMesh::Quad& v = piece_.mesh.quad(side.quad);
      const std::array<int, 2> ends{v[side.corner], v[(side.corner + 1) & 3]};
      witnesses_[i].side = nearest_side(piece_.mesh, witnesses_[i].point, ends);
    }
  }

  Distances distances_at(const Site& site) const {
    Distances out;
    for (const int i : site.witnesses) {
      const double distance = edges(witnesses_[i].side.distance);
      out.largest = std::max(out.largest, distance);
      out.excess += std::pow(std::max(0.0, distance - kNear), 2);
    }
    return out;
  }

  /// Pulls of each side together weigh as much as one would at the largest distance; those of nearer points less, by its square.
  void pull_sides(const Site& site, double weight) {
    double largest = 0;
    std::vector<int> count(4 * site.quads.size(), 0);
    const auto slot_of = [&](const SidePlace& side) {
      return 4 * (std::lower_bound(site.quads.begin(), site.quads.end(), side.quad) - site.quads.begin()) + side.corner;
    };
    const auto is_inside = [&](const SidePlace& side) { return std::binary_search(site.quads.begin(), site.quads.end(), side.quad); };
    for (const int i : site.witnesses) {
      largest = std::max(largest, witnesses_[i].side.distance);
      if (is_inside(witnesses_[i].side)) ++count[slot_of(witnesses_[i].side)];
    }
    pulls_.clear();
    if (!(largest > 0)) return;
    for (const int i : site.witnesses) {
      const SidePlace& side = witnesses_[i].side;
      if (!is_inside(side)) continue;
      PointPulls::Pull pull;
      pull.point = witnesses_[i].point;
      pull.vertices = piece_.mesh.quad(side.quad);
      pull.shares[side.corner] = 1 - side.share;
      pull.shares[(side.corner + 1) & 3] = side.share;
      pull.weight = weight * std::pow(side.distance / largest, 2) / count[slot_of(side)];
      pulls_.add(pull);
    }
  }

  bool is_borne(const Site& site) const {
    constexpr double kGood = 0.8, kLoss = 0.08, kMeanLoss = 0.03;
    double lost = 0;
    for (const int q : site.quads) {
      const double now = smoother_.signed_quality(q);
      if (now < kGood && now < quality_[q] - kLoss) return false;
      lost += quality_[q] - now;
    }
    if (lost > kMeanLoss * static_cast<double>(site.quads.size())) return false;
    return shapes_of(piece_.mesh, site.quads, measure_).are_kept_since(site.shapes);
  }

  /// Pulls get stronger as long as sides come nearer for it and quads bear it.
  bool follow(int quad) {
    constexpr double kWeakest = 16, kStrongest = 128, kStronger = 2;  // weights of pulls
    constexpr double kGain = 0.95, kEps = 1e-3;
    constexpr int kSteps = 3, kSweeps = 2;
    Site site = site_around(quad);
    if (site.vertices.empty()) return false;
    Distances last = distances_at(site);
    bool any = false;
    for (double weight = kWeakest; weight <= kStrongest && last.largest > kFar; weight *= kStronger) {
      for (int step = 0; step < kSteps; ++step) {
        pull_sides(site, weight);
        smoother_.relax(site.vertices, kSweeps, kEps);
        look_again(site);
      }
      effort_ -= kSteps * kSweeps * static_cast<long long>(site.vertices.size());
      smoother_.update_frames(site.quads, true);
      const Distances now = distances_at(site);
      const bool is_nearer = now.largest <= last.largest && now.excess < (any ? 1 : kGain) * last.excess;
      if (is_nearer && is_borne(site)) {
        last = now;
        any = true;
        for (std::size_t i = 0; i < site.vertices.size(); ++i) site.places[i] = piece_.place_of(site.vertices[i]);
        continue;
      }
      for (std::size_t i = 0; i < site.vertices.size(); ++i) piece_.put(site.vertices[i], site.places[i]);
      smoother_.update_frames(site.quads, true);
      look_again(site);
      if (is_nearer || any) break;
    }
    if (any)
      for (const int v : site.vertices) moved_[v] = 1;
    return any;
  }

  Workpiece& piece_;
  const FlawMeasure& measure_;
  const ImproveOptions& options_;
  std::vector<Witness> witnesses_;
  std::vector<std::vector<int>> of_quad_;  ///< witnesses whose nearest side is one of its sides
  std::vector<double> quality_;            ///< of every quad, before all places: they share what quads may lose
  std::vector<char> moved_;                ///< #V
  long long effort_ = 0;                   ///< moves of vertices that are left
  PointPulls pulls_;
  Smoother smoother_;
};

}  // namespace

int follow_creases(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index, double sharp_angle,
                   const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole) {
  if (quads.quads.empty() || !(options.target_length > 0)) return 0;
  const std::vector<int> creases = creases_of(input, features, sharp_angle);
  if (creases.empty()) return 0;
  constexpr double kMostPerQuad = 50;
  const double most = kMostPerQuad * static_cast<double>(quads.quads.size());
  const std::vector<Vector3> points = points_on(creases, input, kApart * options.target_length, most);
  Workpiece piece(quads, input, features, index);
  piece.h = options.target_length;
  std::vector<Witness> witnesses = witnesses_of(points, quads, piece.mesh, context);
  const auto is_far = [&](const Witness& witness) { return witness.side.distance > kFar * piece.h; };
  if (std::none_of(witnesses.begin(), witnesses.end(), is_far)) return 0;
  piece.locate_all(context);
  const FlawMeasure measure(piece, whole ? *whole : index, options.agreement, &options.least_agreement);
  const int places = Following(piece, measure, options, std::move(witnesses), context.threads).run(context);
  if (places > 0) quads = piece.mesh.extract(piece.face);
  return places;
}

}  // namespace hybrid_quad
