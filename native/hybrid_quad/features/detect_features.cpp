#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/features/crease_clarity.h"
#include "hybrid_quad/features/crease_normals.h"
#include "hybrid_quad/features/feature_gaps.h"
#include "hybrid_quad/features/features.h"
#include "hybrid_quad/features/narrow_facets.h"
#include "hybrid_quad/features/parting_angle.h"
#include "hybrid_quad/features/rounds.h"
#include "hybrid_quad/features/small_facets.h"

namespace hybrid_quad {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kChainTurn = 45;         ///< degrees that a chain of weak edges may turn at a vertex
constexpr double kChainShare = 0.5;       ///< longest chain of weak edges, as part of the strong set it continues
constexpr double kQuadShare = 1.0 / 3;    ///< edge length of a quad, of the minimum length
constexpr double kSideShare = 1.0 / 6;    ///< how far the sides of a crease are looked at, of the minimum length
constexpr double kNoClarity = 0.65, kFullClarity = 0.85;  ///< below, an edge says nothing for its set; above, its whole length
constexpr double kNoiseFactor = 4;        ///< where all else is noise, a set must be this much longer again
constexpr double kDoubt = 8;              ///< no set is trusted of which this part (1 / kDoubt) or more is unclear
constexpr double kRoundShare = 0.4;       ///< what rounds need of the minimum length: a bit more than one edge of a quad,
constexpr double kSureRound = 0.9;        ///< where this part of them is clear,
constexpr double kRoundSight = 1 / (4 * 3.14159265358979323846);  ///< seen from half their radius away, of their length
constexpr double kReachShare = 0.28;      ///< least reach of a set, of the minimum length: nearly that of a circle that long

class FeatureDetector {
 public:
  FeatureDetector(const TriangleMesh& mesh, std::vector<Vector3> normals, const FeatureOptions& options)
      : mesh_(mesh), normal_(std::move(normals)), options_(options), marked_(mesh.halfedge_count(), 0), by_angle_(mesh.halfedge_count(), 0),
        weight_(mesh.halfedge_count(), 1.0) {}

  void mark_given_edges();
  void mark_by_angle(const RunContext& context);
  void close_gaps(const RunContext& context);
  void continue_chains(const RunContext& context);
  void weigh_edges(const RunContext& context);
  void drop_noise();
  std::vector<char> result() const;
  int left_out() const { return narrow_ + static_cast<int>(std::count(is_too_small_.begin(), is_too_small_.end(), 1)); }
  double limit() const { return limit_; }  ///< degrees above which edges were taken by angle; 0: none were

 private:
  void see_past_narrow_facets(const std::vector<int>& halfedges);
  int count_narrow(const std::vector<char>& before) const;
  void drop_short_sets();
  void drop_unclear_branches();
  void drop_loose_ends();
  double quad() const { return kQuadShare * options_.minimum_length; }  ///< a quad's edge
  int opposite_or_self(int h) const { return mesh_.opposite(h) < 0 ? h : mesh_.opposite(h); }
  bool stands_for_edge(int h) const { return h <= opposite_or_self(h); }
  bool is_any(int h) const { return marked_[h] || by_angle_[h] || mesh_.is_boundary(h); }
  void set(std::vector<char>& flags, int h, char value) { flags[h] = flags[opposite_or_self(h)] = value; }
  int find_edge(int a, int b) const;
  double angle(int h) const;
  int feature_degree(int v) const;
  int straightest_weak_edge(int v, const Vector3& direction) const;
  void try_chain(int v, double longest);
  double length(int h) const { return mesh_.edge_length(h); }
  double evidence(int h) const { return by_angle_[h] && !marked_[h] ? weight_[h] * length(h) : length(h); }
  template <class Measure>
  std::vector<int> connected_sets(const Measure& measure, std::vector<double>& set_sum) const;
  struct Branch {
    double length = 0, evidence = 0;
    int tip = -1, root = -1;
    std::vector<int> edges;
  };
  Branch branch_from(int tip, int first = -1) const;
  void drop(const Branch& branch) {
    for (const int h : branch.edges) set(by_angle_, h, 0);
  }

  const TriangleMesh& mesh_;
  std::vector<Vector3> normal_;  ///< by face
  const FeatureOptions& options_;
  std::vector<char> marked_, by_angle_;
  double limit_ = 0;
  Rounds rounds_;  ///< of the edges by angle
  std::vector<char> is_too_small_;  ///< by round
  int narrow_ = 0;  ///< curves that only narrow facets showed
  std::vector<double> weight_;  ///< 3 #F: 0..1, how much an edge by angle counts for its set
  double noise_share_ = 0;  ///< of the length of all edges by angle
};

int FeatureDetector::find_edge(int a, int b) const {
  int found = -1;
  const int n = mesh_.vertex_count();
  if (a < 0 || b < 0 || a >= n || b >= n) return -1;
  mesh_.visit_edges_at(a, [&](int h) {
    if (mesh_.to(h) == b || mesh_.from(h) == b) found = h;
  });
  return a == b ? -1 : found;
}

void FeatureDetector::mark_given_edges() {
  std::vector<int> unknown;
  for (const auto& edge : options_.marked_edges) {
    const int h = find_edge(edge[0], edge[1]);
    if (h >= 0) set(marked_, h, 1);
    else unknown.insert(unknown.end(), {edge[0], edge[1]});
  }
  if (!unknown.empty())
    throw InputError("unknown_edge", std::to_string(unknown.size() / 2) + " marked pairs of vertices are no edges of the mesh.",
                     "edge", unknown);
}

double FeatureDetector::angle(int h) const {
  const Vector3& a = normal_[h / 3];
  const Vector3& b = normal_[mesh_.opposite(h) / 3];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void FeatureDetector::mark_by_angle(const RunContext& context) {
  if (!options_.use_sharp_angle || options_.sharp_angle > 180) return;
  std::vector<int> halfedges;
  std::vector<BentEdge> edges;
  for (int h = 0; h < mesh_.halfedge_count(); ++h) {
    if ((h & 0xffff) == 0) context.checkpoint(0.3 * h / mesh_.halfedge_count());
    if (mesh_.is_boundary(h) || marked_[h] || !stands_for_edge(h)) continue;
    halfedges.push_back(h);
    edges.push_back({angle(h) / kDegree, length(h)});
  }
  limit_ = options_.minimum_length > 0 ? parting_angle(edges, options_.sharp_angle) : options_.sharp_angle;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (edges[i].angle > limit_) set(by_angle_, halfedges[i], 1);
  if (options_.minimum_length > 0) see_past_narrow_facets(halfedges);
}

/// Where slivers fold, all their edges are above the angle; a crease is what is above it without them too.
/// \param halfedges  of edges that may be features by angle
void FeatureDetector::see_past_narrow_facets(const std::vector<int>& halfedges) {
  constexpr double kBend = 0.5;  // of the weak angle
  constexpr double kRise = 0.03;
  std::vector<char> may_bend(mesh_.halfedge_count(), 0);
  for (const int h : halfedges) set(may_bend, h, 1);
  std::vector<Vector3> seen = normals_beside_narrow_facets(mesh_, normal_, may_bend, kBend * options_.weak_angle * kDegree,
                                                           limit_ * kDegree, kRise * quad());
  if (seen == normal_) return;
  normal_ = std::move(seen);
  const std::vector<char> before = by_angle_;
  for (const int h : halfedges) set(by_angle_, h, angle(h) > limit_ * kDegree);
  narrow_ = count_narrow(before);
}

/// Curves of edges by angle, rounds or as long as features have to be, of which nothing is left.
int FeatureDetector::count_narrow(const std::vector<char>& before) const {
  const Rounds rounds = find_rounds(mesh_, before, marked_);
  const FeatureGraph curves = trace_features(mesh_, before, corners_for_quads(quad()), options_.corners);
  std::vector<double> curve_length(curves.curves.size(), 0);
  std::vector<char> is_round(curves.curves.size(), 0), is_left(curves.curves.size(), 0);
  for (int h = 0; h < mesh_.halfedge_count(); ++h) {
    const int c = curves.halfedge_curve[h];
    if (c < 0 || !stands_for_edge(h)) continue;
    curve_length[c] += length(h);
    if (is_any(h)) is_left[c] = 1;
    if (rounds.of_halfedge[h] >= 0) is_round[c] = 1;
  }
  int count = 0;
  for (std::size_t c = 0; c < curve_length.size(); ++c)
    count += !is_left[c] && (is_round[c] || curve_length[c] >= options_.minimum_length);
  return count;
}

void FeatureDetector::close_gaps(const RunContext& context) {
  constexpr double kGap = 0.15;
  for (const int h : ways_over_gaps(mesh_, result(), kGap * quad(), context)) set(by_angle_, h, 1);
}

int FeatureDetector::feature_degree(int v) const {
  int degree = 0;
  mesh_.visit_edges_at(v, [&](int h) { degree += is_any(h); });
  return degree;
}

/// The weak edge at v, as a half-edge, that continues `direction` best; -1 if none does or v has other features.
int FeatureDetector::straightest_weak_edge(int v, const Vector3& direction) const {
  int best = -1;
  double best_cosine = std::cos(kChainTurn * kDegree);
  mesh_.visit_edges_at(v, [&](int h) {
    if (is_any(h) || angle(h) <= options_.weak_angle * kDegree) return;
    const Vector3 e = (mesh_.from(h) == v ? 1.0 : -1.0) * mesh_.edge_vector(h);
    const double cosine = e.dot(direction) / std::max(e.norm() * direction.norm(), 1e-300);
    if (cosine > best_cosine) {
      best_cosine = cosine;
      best = h;
    }
  });
  return best;
}

/// Walks from the loose end v of a strong chain over weak edges; keeps them if they reach another feature.
void FeatureDetector::try_chain(int v, double longest) {
  Vector3 direction = Vector3::Zero();
  mesh_.visit_edges_at(v, [&](int h) {
    if (is_any(h)) direction = (mesh_.from(h) == v ? -1.0 : 1.0) * mesh_.edge_vector(h);
  });
  std::vector<int> chain;
  double length = 0;
  for (;;) {
    const int h = straightest_weak_edge(v, direction);
    if (h < 0) return;
    chain.push_back(h);
    direction = (mesh_.from(h) == v ? 1.0 : -1.0) * mesh_.edge_vector(h);
    length += direction.norm();
    v = mesh_.other_end(h, v);
    if (length > longest) return;
    if (feature_degree(v) > 0) break;
  }
  for (const int h : chain) set(by_angle_, h, 1);
}

void FeatureDetector::continue_chains(const RunContext& context) {
  if (!options_.use_sharp_angle || options_.sharp_angle > 180 || options_.weak_angle >= options_.sharp_angle) return;
  std::vector<double> set_length;
  const std::vector<int> set_of = connected_sets([this](int h) { return length(h); }, set_length);
  for (int v = 0; v < mesh_.vertex_count(); ++v) {
    if ((v & 0xffff) == 0) context.checkpoint(0.4);
    if (mesh_.outgoing(v) >= 0 && set_length[set_of[v]] > 0 && feature_degree(v) == 1)
      try_chain(v, kChainShare * set_length[set_of[v]]);
  }
}

/// A root for every vertex, the same along connected feature edges, and the sum of a measure of the edges of every root's set.
template <class Measure>
std::vector<int> FeatureDetector::connected_sets(const Measure& measure, std::vector<double>& set_sum) const {
  std::vector<int> parent(mesh_.vertex_count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (int h = 0; h < mesh_.halfedge_count(); ++h)
    if (is_any(h) && stands_for_edge(h)) {
      const int a = root(mesh_.from(h)), b = root(mesh_.to(h));
      parent[std::max(a, b)] = std::min(a, b);
    }
  for (int v = 0; v < mesh_.vertex_count(); ++v) parent[v] = root(v);
  set_sum.assign(mesh_.vertex_count(), 0);
  for (int h = 0; h < mesh_.halfedge_count(); ++h)
    if (is_any(h) && stands_for_edge(h)) set_sum[parent[mesh_.from(h)]] += measure(h);
  return parent;
}

/// On a sculpt or scan, edges bend by chance, or because triangles are as large as the radius of a ridge.
void FeatureDetector::weigh_edges(const RunContext& context) {
  if (std::find(by_angle_.begin(), by_angle_.end(), 1) == by_angle_.end()) return;
  rounds_ = find_rounds(mesh_, by_angle_, marked_);
  is_too_small_.assign(rounds_.length.size(), 0);
  const std::vector<char> barriers = result();
  const std::vector<char> in_facet = small_facets(mesh_, normal_, barriers, quad());
  CreaseClarity clarity(mesh_, normal_, barriers);
  const double side = kSideShare * options_.minimum_length;
  for (int h = 0; h < mesh_.halfedge_count(); ++h) {
    if ((h & 0xfff) == 0) context.checkpoint(0.4 + 0.2 * h / mesh_.halfedge_count());
    if (!by_angle_[h] || marked_[h] || !stands_for_edge(h)) continue;
    const int round = rounds_.of_halfedge[h];
    const bool fences_facet = round < 0 && (in_facet[h / 3] || in_facet[mesh_.opposite(h) / 3]);
    const double sight = round >= 0 ? std::min(kRoundSight * rounds_.length[round], side) : side;
    const double weight = fences_facet ? 0 : std::clamp((clarity(h, sight) - kNoClarity) / (kFullClarity - kNoClarity), 0.0, 1.0);
    weight_[h] = weight_[opposite_or_self(h)] = weight;
  }
}

/// A set of edges by angle stays if it has enough clear length, and goes far enough to be no clump of noise.
void FeatureDetector::drop_short_sets() {
  std::vector<double> clear_length, set_length;
  connected_sets([this](int h) { return length(h); }, set_length);
  const std::vector<int> set_of = connected_sets([this](int h) { return evidence(h); }, clear_length);
  // From any vertex of a set to the farthest, and from there to the farthest again.
  std::vector<int> farthest = set_of;
  std::vector<double> reach;
  for (int sweep = 0; sweep < 2; ++sweep) {
    const std::vector<int> from = farthest;
    reach.assign(mesh_.vertex_count(), 0);
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      const int s = set_of[v];
      const double distance = (mesh_.position(v) - mesh_.position(from[s])).norm();
      if (distance > reach[s]) {
        reach[s] = distance;
        farthest[s] = v;
      }
    }
  }
  std::vector<char> has_given(mesh_.vertex_count(), 0);
  for (int h = 0; h < mesh_.halfedge_count(); ++h)
    if (marked_[h] || mesh_.is_boundary(h)) has_given[set_of[mesh_.from(h)]] = 1;
  const double least = options_.minimum_length;
  for (int h = 0; h < mesh_.halfedge_count(); ++h) {
    if (!by_angle_[h]) continue;
    const int s = set_of[mesh_.from(h)];
    const double doubt = std::clamp(kDoubt * (1 - clear_length[s] / set_length[s]), noise_share_ * noise_share_, 1.0);
    const int round = rounds_.of_halfedge[h];
    const bool is_sure_round = round >= 0 && clear_length[s] > kSureRound * set_length[s];
    const double enough = (is_sure_round ? kRoundShare : 1.0) * least;
    const bool is_short = clear_length[s] < enough * (1 + kNoiseFactor * noise_share_ * doubt);
    const bool is_clump = !has_given[s] && reach[s] < kReachShare * enough;
    if (!is_short && !is_clump) continue;
    by_angle_[h] = 0;
    if (is_sure_round) is_too_small_[round] = 1;
  }
}

/// Drops what is too short; and, the more that was, the longer the others have to be, those that are not clear above all:
/// where most edges above the angle are noise, chance also makes longer chains of them.
void FeatureDetector::drop_noise() {
  const auto sum_by_angle = [this](const auto& measure) {
    double sum = 0;
    for (int h = 0; h < mesh_.halfedge_count(); ++h)
      if (by_angle_[h] && !marked_[h]) sum += measure(h);
    return sum;
  };
  const auto length_of_edge = [this](int h) { return length(h); };
  const double all = sum_by_angle(length_of_edge);
  const double clear = sum_by_angle([this](int h) { return evidence(h); });
  drop_short_sets();
  const double kept = sum_by_angle(length_of_edge);
  if (!(kept > 0)) return;
  noise_share_ = 1 - std::min(clear, kept) / all;
  drop_short_sets();
  drop_unclear_branches();
  drop_loose_ends();
  drop_short_sets();
}

/// The chain of edges by angle from a vertex to the next junction, corner of marks, or loose end.
/// \param first the half-edge it begins with; -1: any at `tip`
FeatureDetector::Branch FeatureDetector::branch_from(int tip, int first) const {
  Branch branch;
  branch.tip = tip;
  int v = tip, came = -1;
  do {
    int out = first;
    first = -1;
    if (out < 0)
      mesh_.visit_edges_at(v, [&](int h) {
        if (by_angle_[h] && !marked_[h] && h != came && opposite_or_self(h) != came) out = h;
      });
    if (out < 0) break;
    branch.edges.push_back(out);
    branch.length += length(out);
    branch.evidence += evidence(out);
    came = out;
    v = mesh_.other_end(out, v);
  } while (feature_degree(v) == 2 && v != tip);
  branch.root = v;
  return branch;
}

/// Short branches of a set that say next to nothing for it: chance edges between the lines of a crease, or of a clump.
void FeatureDetector::drop_unclear_branches() {
  constexpr double kUnclear = 0.2;
  std::vector<Branch> unclear;
  for (int v = 0; v < mesh_.vertex_count(); ++v) {
    if (mesh_.outgoing(v) < 0 || feature_degree(v) < 3) continue;
    mesh_.visit_edges_at(v, [&](int h) {
      if (!by_angle_[h] || marked_[h]) return;
      Branch branch = branch_from(v, h);
      if (branch.length < options_.minimum_length && branch.evidence < kUnclear * branch.length)
        unclear.push_back(std::move(branch));
    });
  }
  for (const Branch& branch : unclear) drop(branch);
}

/// Short twigs that end inside a region are noise of a sculpt or scan. The least clear at every junction goes first, so
/// that a long crease keeps the better of two twigs at its end.
void FeatureDetector::drop_loose_ends() {
  for (bool changed = true; changed;) {
    std::vector<Branch> twigs;
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      if (mesh_.outgoing(v) < 0 || feature_degree(v) != 1) continue;
      Branch branch = branch_from(v);
      if (!branch.edges.empty() && branch.evidence < options_.minimum_length && feature_degree(branch.root) > 2)
        twigs.push_back(std::move(branch));
    }
    std::stable_sort(twigs.begin(), twigs.end(), [](const Branch& a, const Branch& b) { return a.evidence < b.evidence; });
    std::vector<char> touched(twigs.empty() ? 0 : mesh_.vertex_count(), 0);
    changed = false;
    for (const Branch& twig : twigs) {
      if (touched[twig.root]) continue;
      touched[twig.root] = 1;
      drop(twig);
      changed = true;
    }
  }
}

std::vector<char> FeatureDetector::result() const {
  std::vector<char> is_feature(mesh_.halfedge_count());
  for (int h = 0; h < mesh_.halfedge_count(); ++h) is_feature[h] = is_any(h);
  return is_feature;
}

}  // namespace

FeatureGraph detect_features(const TriangleMesh& mesh, const std::vector<Vector3>& normals, const FeatureOptions& options,
                             const RunContext& context) {
  FeatureDetector detector(mesh, normals, options);
  detector.mark_given_edges();
  detector.mark_by_angle(context);
  detector.continue_chains(context);
  if (options.minimum_length > 0) {
    detector.close_gaps(context);
    detector.weigh_edges(context);
    detector.drop_noise();
  }
  context.checkpoint(0.7);
  CornerRule corners = corners_for_quads(kQuadShare * options.minimum_length);
  corners.angle = options.corner_angle;
  FeatureGraph features = trace_features(mesh, detector.result(), corners, options.corners);
  features.sharp_angle = detector.limit();
  features.left_out = detector.left_out();
  return features;
}

FeatureGraph detect_features(const TriangleMesh& mesh, const FeatureOptions& options, const RunContext& context) {
  return detect_features(mesh, crease_normals(mesh), options, context);
}

}  // namespace hybrid_quad
