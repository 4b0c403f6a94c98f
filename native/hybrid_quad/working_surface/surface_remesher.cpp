#include "hybrid_quad/working_surface/surface_remesher.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "hybrid_quad/base/parallel.h"

namespace hybrid_quad {

namespace {

constexpr double kLong = 4.0 / 3;   ///< of the aimed length: edges beyond are split
constexpr double kShort = 4.0 / 5;  ///< edges below are collapsed
constexpr int kRounds = 5;
constexpr int kFinalRounds = 3;

}  // namespace

SurfaceRemesher::SurfaceRemesher(const SurfaceIndex& index, const FeatureGraph& features,
                                 const std::vector<double>& target_length, const WorkingSurfaceOptions& options,
                                 const RunContext& context)
    : context_(context), options_(options), input_region_(features.face_region), index_(index),
      mesh_(index.mesh(), features.halfedge_curve, features.face_region), vertex_(index.mesh().vertex_count()),
      changed_at_(index.mesh().face_count(), 1), relaxed_at_(index.mesh().vertex_count(), 0) {
  const TriangleMesh& input = index.mesh();
  for (int v = 0; v < input.vertex_count(); ++v) {
    VertexData& d = vertex_[v];
    d.target = target_length[v];
    d.input = v;
    d.hint = input.outgoing(v) / 3;
    d.on_feature = features.on_feature[v];
    d.is_corner = features.is_corner[v];
  }
  for (const FeatureCurve& c : features.curves) {
    curve_edges_.push_back(static_cast<int>(c.vertices.size()) - 1);
    curve_is_loop_.push_back(c.vertices.front() == c.vertices.back());
    curve_originals_.push_back(static_cast<int>(c.vertices.size()) - (c.closed ? 1 : 2));
  }
}

void SurfaceRemesher::run() {
  flip_edges();
  // Shortest edges first, coarsely: collapses of a level see edges of much the same length.
  for (const double part : {0.125, 0.25, 0.5, 1.0}) collapse_short_edges(part * kShort);
  progress_ = 0.4;
  split_feature_edges();
  for (int round = 0; round < kRounds; ++round) {
    split_long_edges(kLong);
    if (round == 0) renumber();
    flip_edges();
    collapse_short_edges(kShort);
    flip_edges();
    relax();
    progress_ = 0.4 + 0.4 * (round + 1) / kRounds;
    context_.checkpoint(progress_);
  }
  final_phase_ = true;
  for (int round = 0; round < kFinalRounds; ++round) {
    split_feature_edges();
    split_edges_between_features();
    split_long_edges(kLong);
    flip_edges();
    collapse_short_edges(round + 1 < kFinalRounds ? kShort : 0.5);
    flip_edges();
    relax();
    relax();
  }
  // The last word: the contract's limits, whatever it does to the triangles' shape.
  split_feature_edges();
  split_edges_between_features();
  flip_edges();
  relax();
  open_faces_without_area();
  renumber();
  context_.checkpoint(0.95);
}

/// Splitting puts what is near on the surface far apart in memory, where every stage then waits for it.
void SurfaceRemesher::renumber() {
  EditableMesh::Compacted compacted = mesh_.compacted_by_neighbourhood();
  std::vector<VertexData> vertex;
  vertex.reserve(compacted.vertex_slot.size());
  for (const int slot : compacted.vertex_slot) vertex.push_back(vertex_[slot]);
  vertex_ = std::move(vertex);
  mesh_ = EditableMesh(compacted.mesh, std::move(compacted.halfedge_curve), std::move(compacted.face_region));
  changed_at_.assign(mesh_.face_slots(), ++time_);
  relaxed_at_.assign(mesh_.vertex_slots(), 0);
}

void SurfaceRemesher::collapse_short_edges(double longest) {
  for (int h = 0; h < mesh_.halfedge_slots(); ++h) {
    if (!stands_for_edge(h)) continue;
    checkpoint();
    const double aim = is_feature(h) ? 0.9 * options_.feature_edge_limit : options_.edge_fraction;
    const double limit = longest * aim * edge_target(h);
    if (mesh_.edge_vector(h).squaredNorm() >= limit * limit) continue;
    const int o = mesh_.opposite(h);
    // The end that is freer moves; among equals the one with more faces stays.
    const VertexData &a = vertex_[mesh_.from(h)], &b = vertex_[mesh_.to(h)];
    const int rank_a = a.is_corner ? 2 : a.on_feature, rank_b = b.is_corner ? 2 : b.on_feature;
    if (rank_a <= rank_b && try_collapse(h)) continue;
    if (o >= 0 && rank_b <= rank_a) try_collapse(o);
  }
}

void SurfaceRemesher::split_long_edges(double longest) {
  struct Long {
    float length2;  // single precision: halves of an edge are equal, however the surface lies in space
    int halfedge;
  };
  std::vector<Long> edges;
  constexpr int kMaxPasses = 40;
  for (int pass = 0, begin = 0; pass < kMaxPasses; ++pass) {
    edges.clear();
    for (int h = begin; h < mesh_.halfedge_slots(); ++h) {
      if (!stands_for_edge(h) || is_feature(h)) continue;
      const double length2 = mesh_.edge_vector(h).squaredNorm(), limit = longest * options_.edge_fraction * edge_target(h);
      if (length2 > limit * limit) edges.push_back({static_cast<float>(length2), h});
    }
    if (edges.empty()) return;
    std::sort(edges.begin(), edges.end(), [](const Long& x, const Long& y) {
      return x.length2 != y.length2 ? x.length2 > y.length2 : x.halfedge < y.halfedge;
    });
    // Only the longest third of the lengths in one pass: splitting long sides first keeps the new triangles compact.
    const float least = edges.front().length2 * 0.2499f;  // halves of the longest are in
    for (const Long& e : edges) {
      if (e.length2 < least) break;
      checkpoint();
      split(e.halfedge, 0.5);
    }
    flip_edges();
  }
}

/// Splits feature edges into equal parts no longer than the limit, and curves with too few edges once more: by halves, with
/// flips in between, so that no vertex collects all parts of an edge.
void SurfaceRemesher::split_feature_edges() {
  for (bool changed = true; changed;) {
    changed = false;
    for (int h = 0, end = mesh_.halfedge_slots(); h < end; ++h) {
      if (!stands_for_edge(h) || !is_feature(h)) continue;
      const int c = mesh_.curve(h);
      const double limit = options_.feature_edge_limit * edge_target(h);
      const double length = mesh_.edge_vector(h).norm();
      int parts = static_cast<int>(std::min(1e6, std::ceil(length / limit * (1 - 1e-9))));
      if (curve_edges_[c] < (curve_is_loop_[c] ? 4 : 2)) parts = std::max(parts, 2);
      if (parts < 2) continue;
      checkpoint();
      split(h, static_cast<double>(parts / 2) / parts);
      changed = true;
    }
    if (changed) flip_edges();
  }
}

void SurfaceRemesher::split_edges_between_features() {
  for (int h = 0; h < mesh_.halfedge_slots(); ++h)
    if (stands_for_edge(h) && joins_features(h)) {
      checkpoint();
      split(h, 0.5);
    }
}

/// Towards the Delaunay triangulation, where that does not move the surface. Edges that want to and may not count as changed for the next time.
void SurfaceRemesher::flip_edges() {
  std::vector<int> stack;
  for (int h = mesh_.halfedge_slots() - 1; h >= 0; --h)
    if (stands_for_edge(h) && has_changed(h) && wants_flip(h)) stack.push_back(h);
  flipped_at_ = time_++;
  long long flips_left = 4LL * mesh_.halfedge_slots();
  while (!stack.empty() && flips_left > 0) {
    const int h = stack.back();
    stack.pop_back();
    checkpoint();
    if (!wants_flip(h)) continue;
    const int o = mesh_.opposite(h);
    changed_at_[h / 3] = changed_at_[o / 3] = time_;
    if (!mesh_.can_flip(h) || !flip_keeps_shape(h)) continue;
    mesh_.flip_edge(h);
    --flips_left;
    for (const int k : {EditableMesh::next(h), EditableMesh::previous(h), EditableMesh::next(o), EditableMesh::previous(o)})
      stack.push_back(k);
  }
  for (const int h : stack) changed_at_[h / 3] = time_;
}

/// Where neither a collapse nor a flip could remove a face without area, one of its corners moves by a hair.
void SurfaceRemesher::open_faces_without_area() {
  for (int f = 0; f < mesh_.face_slots(); ++f)
    if (mesh_.is_face(f) && !(mesh_.area_normal(f).norm() > 0)) try_open(f);
}

/// One colour after the other: vertices of a colour have no face in common, so that each moves as if alone.
void SurfaceRemesher::relax() {
  for (const std::vector<int>& vertices : free_vertices_by_colour()) {
    ++time_;
    parallel_chunks(static_cast<int>(vertices.size()), context_, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) relax_vertex(vertices[i]);
    });
  }
}

/// The vertices off features in groups without neighbours: each gets the first colour that no neighbour has.
std::vector<std::vector<int>> SurfaceRemesher::free_vertices_by_colour() const {
  constexpr unsigned kMostColours = 64;
  std::vector<std::vector<int>> groups;
  std::vector<signed char> colour(mesh_.vertex_slots(), -1);
  for (int v = 0; v < mesh_.vertex_slots(); ++v) {
    if (!mesh_.is_vertex(v) || vertex_[v].on_feature) continue;
    std::uint64_t taken = 0;
    const auto take = [&](int w) {
      if (colour[w] >= 0) taken |= std::uint64_t{1} << colour[w];
    };
    mesh_.visit_outgoing(v, [&](int h) {
      take(mesh_.to(h));
      take(mesh_.apex(h));
    });
    unsigned c = 0;
    while (c < kMostColours && (taken >> c & 1)) ++c;
    if (c == kMostColours) continue;  // a vertex with so many neighbours may stay where it is
    colour[v] = static_cast<signed char>(c);
    if (c == groups.size()) groups.emplace_back();
    groups[c].push_back(v);
  }
  return groups;
}

}  // namespace hybrid_quad
