#include "hybrid_quad/sizing/feature_size.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

#include "hybrid_quad/sizing/bent_curves.h"

namespace hybrid_quad {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Calls visit(h) for a half-edge of every edge of the mesh.
template <class Visit>
void visit_edges(const TriangleMesh& mesh, Visit visit) {
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.opposite(h) < h) visit(h);
}

/// Propagates values over edges, smallest first: `step(value, edge length)` is what a neighbour gets at most.
/// \param label  handed on with the value where not empty
void propagate(const TriangleMesh& mesh, std::vector<double>& value, std::vector<int>& label, double stop,
               const std::function<double(double, double)>& step, const RunContext& context) {
  constexpr unsigned kStepsUnasked = 1u << 16;  // a few hundredths of a second
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (value[v] < stop) queue.emplace(value[v], v);
  for (unsigned steps = 1; !queue.empty(); ++steps) {
    if (steps % kStepsUnasked == 0) context.checkpoint();
    const double at = queue.top().first;  // no structured binding: C++17 does not let lambdas take these
    const int v = queue.top().second;
    queue.pop();
    if (at > value[v] || mesh.outgoing(v) < 0) continue;
    const auto offer = [&](int w, double length) {
      const double reached = step(at, length);
      if (reached >= value[w] || reached >= stop) return;
      value[w] = reached;
      if (!label.empty()) label[w] = label[v];
      queue.emplace(reached, w);
    };
    const int first = mesh.outgoing(v);
    for (int h = first; h >= 0;) {
      offer(mesh.to(h), mesh.edge_length(h));
      const int in = TriangleMesh::previous(h);
      if (mesh.is_boundary(in)) offer(mesh.from(in), mesh.edge_length(in));
      h = mesh.rotate_ccw(h);
      if (h == first) break;
    }
  }
}

bool share_a_node(const FeatureCurve& a, const FeatureCurve& b) {
  if (a.closed || b.closed) return false;
  for (const int v : {a.vertices.front(), a.vertices.back()})
    if (v == b.vertices.front() || v == b.vertices.back()) return true;
  return false;
}

double length_of(const TriangleMesh& mesh, const FeatureCurve& curve) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
    sum += (mesh.position(curve.vertices[i + 1]) - mesh.position(curve.vertices[i])).norm();
  return sum;
}

}  // namespace

std::vector<double> feature_sized_lengths(const SurfaceIndex& index, const FeatureGraph& features, double length,
                                          const std::vector<ThinPlace>& thin, const FeatureSizeOptions& options,
                                          const RunContext& context) {
  const TriangleMesh& mesh = index.mesh();
  std::vector<double> target(mesh.vertex_count(), length);
  const double least = options.least_ratio * length;
  // A quad edge may be this much longer than the room it has: Psi rounds to the nearest number of quads.
  constexpr double kStretch = 1.4;
  const auto limit = [&](int v, double room) { target[v] = std::min(target[v], std::max(kStretch * room, least)); };
  // The nearest curve of every vertex within reach, and how far it is.
  std::vector<double> distance(mesh.vertex_count(), kFar);
  std::vector<int> nearest(mesh.vertex_count(), -1);
  for (std::size_t c = 0; c < features.curves.size(); ++c) {
    const FeatureCurve& curve = features.curves[c];
    const double room = length_of(mesh, curve) / (curve.closed ? 4 : 1);
    limit_lengths_of_bends(mesh, curve, length, target);
    for (const int v : curve.vertices) {
      if (room < length) limit(v, room);
      if (features.is_corner[v]) continue;
      distance[v] = 0;
      nearest[v] = static_cast<int>(c);
    }
  }
  context.checkpoint(0.3);
  propagate(mesh, distance, nearest, length, [](double at, double edge) { return at + edge; }, context);
  visit_edges(mesh, [&](int h) {
    const int a = mesh.from(h), b = mesh.to(h);
    if (nearest[a] < 0 || nearest[b] < 0 || nearest[a] == nearest[b]) return;
    if (share_a_node(features.curves[nearest[a]], features.curves[nearest[b]])) return;
    const double gap = distance[a] + mesh.edge_length(h) + distance[b];
    if (gap >= length) return;
    limit(a, gap);
    limit(b, gap);
  });
  context.checkpoint(0.5);
  for (const ThinPlace& place : thin)
    target[place.vertex] = std::min(target[place.vertex], std::max(place.length, options.thin_ratio * length));
  grade_lengths(mesh, length, target, options.growth, context);
  return target;
}

void limit_lengths(const SurfaceIndex& index, const std::vector<LengthLimit>& limits, std::vector<double>& length) {
  for (const LengthLimit& place : limits) {
    const SurfacePoint nearest = index.nearest(place.position);
    if (nearest.face < 0) continue;
    for (const int v : index.mesh().face(nearest.face)) length[v] = std::min(length[v], place.length);
  }
}

void grade_lengths(const TriangleMesh& mesh, double longest, std::vector<double>& length, double growth, const RunContext& context) {
  std::vector<int> none;
  propagate(mesh, length, none, longest, [&](double at, double edge) { return at + growth * edge; }, context);
}

double quads_for_lengths(const TriangleMesh& mesh, const std::vector<double>& length) {
  double sum = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto& v = mesh.face(f);
    double density = 0;
    for (const int corner : v) density += 1 / (3 * length[corner] * length[corner]);
    sum += mesh.area(f) * density;
  }
  return sum;
}

}  // namespace hybrid_quad
