#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/features/features.h"

namespace hybrid_quad {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kSliver = 1e-7;          ///< height over longest edge below which a face's normal is noise
constexpr double kChainTurn = 45;         ///< degrees that a chain of weak edges may turn at a vertex
constexpr double kChainShare = 0.5;       ///< longest chain of weak edges, as part of the strong set it continues

class FeatureDetector {
 public:
  FeatureDetector(const TriangleMesh& mesh, const FeatureOptions& options)
      : mesh_(mesh), options_(options), marked_(mesh.halfedge_count(), 0), by_angle_(mesh.halfedge_count(), 0) {}

  void mark_given_edges();
  void mark_by_angle(const RunContext& context);
  void continue_chains(const RunContext& context);
  void drop_loose_ends();
  void drop_short_sets();
  std::vector<char> result() const;

 private:
  int opposite_or_self(int h) const { return mesh_.opposite(h) < 0 ? h : mesh_.opposite(h); }
  bool stands_for_edge(int h) const { return h <= opposite_or_self(h); }
  bool is_any(int h) const { return marked_[h] || by_angle_[h] || mesh_.is_boundary(h); }
  void set(std::vector<char>& flags, int h, char value) { flags[h] = flags[opposite_or_self(h)] = value; }
  int find_edge(int a, int b) const;
  void compute_normals();
  double angle(int h) const;
  /// Calls visit(h) for a half-edge of every edge at v, h leaving v except for the last one of a boundary fan.
  template <class Visit>
  void visit_edges_at(int v, Visit&& visit) const;
  int feature_degree(int v) const;
  int straightest_weak_edge(int v, const Vector3& direction) const;
  void try_chain(int v, double longest);
  std::vector<int> connected_sets(std::vector<double>& set_length) const;
  struct Branch {
    double length = 0;
    int tip = -1, root = -1;
    std::vector<int> edges;
  };
  Branch branch_from(int tip) const;

  const TriangleMesh& mesh_;
  const FeatureOptions& options_;
  std::vector<char> marked_, by_angle_;
  std::vector<Vector3> normal_;
};

template <class Visit>
void FeatureDetector::visit_edges_at(int v, Visit&& visit) const {
  const int start = mesh_.outgoing(v);
  for (int h = start; h >= 0;) {
    visit(h);
    const int previous = TriangleMesh::previous(h);
    if (mesh_.is_boundary(previous)) {
      visit(previous);
      return;
    }
    h = mesh_.opposite(previous);
    if (h == start) return;
  }
}

int FeatureDetector::find_edge(int a, int b) const {
  int found = -1;
  const int n = mesh_.vertex_count();
  if (a < 0 || b < 0 || a >= n || b >= n) return -1;
  visit_edges_at(a, [&](int h) {
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
    throw InputError("unknown_edge", std::to_string(unknown.size() / 2) + " marked pairs of vertices are no edges of the mesh",
                     "edge", unknown);
}

/// A sliver takes the normal of the face across its longest edge: its own one is rounding noise.
void FeatureDetector::compute_normals() {
  const int face_count = mesh_.face_count();
  normal_.resize(face_count);
  std::vector<int> across(face_count, -1);
  for (int f = 0; f < face_count; ++f) {
    normal_[f] = mesh_.normal(f);
    int longest = 3 * f;
    for (int h = 3 * f + 1; h < 3 * f + 3; ++h)
      if (mesh_.edge_vector(h).squaredNorm() > mesh_.edge_vector(longest).squaredNorm()) longest = h;
    if (2 * mesh_.area(f) <= kSliver * mesh_.edge_vector(longest).squaredNorm())
      across[f] = mesh_.is_boundary(longest) ? f : mesh_.opposite(longest) / 3;
  }
  for (int f = 0; f < face_count; ++f) {
    int g = f;
    for (int step = 0; step < 32 && across[g] >= 0 && across[g] != g; ++step) g = across[g];
    if (g != f && across[g] < 0) normal_[f] = normal_[g];
  }
}

double FeatureDetector::angle(int h) const {
  const Vector3& a = normal_[h / 3];
  const Vector3& b = normal_[mesh_.opposite(h) / 3];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void FeatureDetector::mark_by_angle(const RunContext& context) {
  if (!options_.use_sharp_angle || options_.sharp_angle > 180) return;
  compute_normals();
  const double limit = options_.sharp_angle * kDegree;
  for (int h = 0; h < mesh_.halfedge_count(); ++h) {
    if ((h & 0xffff) == 0) context.checkpoint(0.3 * h / mesh_.halfedge_count());
    if (!mesh_.is_boundary(h) && stands_for_edge(h) && angle(h) > limit) set(by_angle_, h, 1);
  }
}

int FeatureDetector::feature_degree(int v) const {
  int degree = 0;
  visit_edges_at(v, [&](int h) { degree += is_any(h); });
  return degree;
}

/// The weak edge at v, as a half-edge, that continues `direction` best; -1 if none does or v has other features.
int FeatureDetector::straightest_weak_edge(int v, const Vector3& direction) const {
  int best = -1;
  double best_cosine = std::cos(kChainTurn * kDegree);
  visit_edges_at(v, [&](int h) {
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
  visit_edges_at(v, [&](int h) {
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
    v = mesh_.from(h) == v ? mesh_.to(h) : mesh_.from(h);
    if (length > longest) return;
    if (feature_degree(v) > 0) break;
  }
  for (const int h : chain) set(by_angle_, h, 1);
}

void FeatureDetector::continue_chains(const RunContext& context) {
  if (!options_.use_sharp_angle || options_.sharp_angle > 180 || options_.weak_angle >= options_.sharp_angle) return;
  std::vector<double> set_length;
  const std::vector<int> set_of = connected_sets(set_length);
  for (int v = 0; v < mesh_.vertex_count(); ++v) {
    if ((v & 0xffff) == 0) context.checkpoint(0.4);
    if (mesh_.outgoing(v) >= 0 && set_length[set_of[v]] > 0 && feature_degree(v) == 1)
      try_chain(v, kChainShare * set_length[set_of[v]]);
  }
}

/// A root for every vertex, the same along connected feature edges, and the length of edges of every root's set.
std::vector<int> FeatureDetector::connected_sets(std::vector<double>& set_length) const {
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
  set_length.assign(mesh_.vertex_count(), 0);
  for (int h = 0; h < mesh_.halfedge_count(); ++h)
    if (is_any(h) && stands_for_edge(h)) set_length[parent[mesh_.from(h)]] += mesh_.edge_length(h);
  return parent;
}

void FeatureDetector::drop_short_sets() {
  if (!(options_.minimum_length > 0)) return;
  std::vector<double> set_length;
  const std::vector<int> set_of = connected_sets(set_length);
  for (int h = 0; h < mesh_.halfedge_count(); ++h)
    if (by_angle_[h] && set_length[set_of[mesh_.from(h)]] < options_.minimum_length) by_angle_[h] = 0;
}

/// The chain of edges by angle from a loose end to the next junction, corner of marks, or other loose end.
FeatureDetector::Branch FeatureDetector::branch_from(int tip) const {
  Branch branch;
  branch.tip = tip;
  int v = tip, came = -1;
  do {
    int out = -1;
    visit_edges_at(v, [&](int h) {
      if (by_angle_[h] && !marked_[h] && h != came && opposite_or_self(h) != came) out = h;
    });
    if (out < 0) break;
    branch.edges.push_back(out);
    branch.length += mesh_.edge_length(out);
    came = out;
    v = mesh_.from(out) == v ? mesh_.to(out) : mesh_.from(out);
  } while (feature_degree(v) == 2 && v != tip);
  branch.root = v;
  return branch;
}

/// Short twigs that end inside a region are noise of a sculpt or scan. The shortest at every junction goes first, so
/// that a long crease keeps the better of two twigs at its end.
void FeatureDetector::drop_loose_ends() {
  if (!(options_.minimum_length > 0)) return;
  for (bool changed = true; changed;) {
    std::vector<Branch> twigs;
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      if (mesh_.outgoing(v) < 0 || feature_degree(v) != 1) continue;
      Branch branch = branch_from(v);
      if (!branch.edges.empty() && branch.length < options_.minimum_length && feature_degree(branch.root) > 2)
        twigs.push_back(std::move(branch));
    }
    std::stable_sort(twigs.begin(), twigs.end(), [](const Branch& a, const Branch& b) { return a.length < b.length; });
    std::vector<char> touched(twigs.empty() ? 0 : mesh_.vertex_count(), 0);
    changed = false;
    for (const Branch& twig : twigs) {
      if (touched[twig.root]) continue;
      touched[twig.root] = 1;
      for (const int h : twig.edges) set(by_angle_, h, 0);
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

FeatureGraph detect_features(const TriangleMesh& mesh, const FeatureOptions& options, const RunContext& context) {
  FeatureDetector detector(mesh, options);
  detector.mark_given_edges();
  detector.mark_by_angle(context);
  detector.continue_chains(context);
  detector.drop_short_sets();
  detector.drop_loose_ends();
  detector.drop_short_sets();
  context.checkpoint(0.7);
  return trace_features(mesh, detector.result(), options.corner_angle);
}

}  // namespace hybrid_quad
