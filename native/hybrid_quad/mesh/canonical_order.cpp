#include "hybrid_quad/mesh/canonical_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <tuple>

#include "hybrid_quad/mesh/first_halfedge.h"

namespace hybrid_quad {

namespace {

constexpr double kSame = 1e-7;  ///< of the greatest: squared lengths that differ by less are the same

/// What tells components apart without their numbers: the greatest comes first.
struct Start {
  int halfedge;
  std::array<double, 4> lengths2;  ///< squared: of the half-edge, and of its face's corners from the middle of all
  std::array<double, 3> corner;    ///< where it begins: turns with the surface, the lengths do not
};

/// Sorts starts[begin, end), of which the lengths before number k are the same.
void sort_starts(std::vector<Start>& starts, std::size_t begin, std::size_t end, std::size_t k, double greatest2) {
  const auto first = starts.begin() + static_cast<std::ptrdiff_t>(begin), last = starts.begin() + static_cast<std::ptrdiff_t>(end);
  if (k == std::tuple_size<decltype(Start::lengths2)>::value) {
    std::stable_sort(first, last, [](const Start& x, const Start& y) { return x.corner > y.corner; });
    return;
  }
  std::stable_sort(first, last, [k](const Start& x, const Start& y) { return x.lengths2[k] > y.lengths2[k]; });
  for (std::size_t i = begin; i < end;) {
    std::size_t next = i + 1;
    while (next < end && starts[next - 1].lengths2[k] - starts[next].lengths2[k] <= kSame * greatest2) ++next;
    if (next > i + 1) sort_starts(starts, i, next, k + 1, greatest2);
    i = next;
  }
}

/// For each component the half-edge to begin with, the component with the longest edge first.
std::vector<int> starts_of(const TriangleMesh& mesh, const RunContext& context) {
  std::vector<int> all(mesh.face_count());
  std::iota(all.begin(), all.end(), 0);
  if (all.empty()) return {};
  const Vector3 middle = middle_of(mesh, all);
  std::vector<char> seen(mesh.face_count(), 0);
  std::vector<Start> starts;
  std::vector<int> faces;
  double greatest2 = 0;
  std::size_t steps = 0;
  for (int seed = 0; seed < mesh.face_count(); ++seed) {
    if (seen[seed]) continue;
    seen[seed] = 1;
    faces = {seed};
    for (std::size_t i = 0; i < faces.size(); ++i) {
      context.checkpoint_at(++steps);
      for (int h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
        const int o = mesh.opposite(h);
        if (o < 0 || seen[o / 3]) continue;
        seen[o / 3] = 1;
        faces.push_back(o / 3);
      }
    }
    const int h = first_halfedge(mesh, faces, context);
    Start start{h, {mesh.edge_vector(h).squaredNorm()}, {}};
    int corner = h;
    for (int i = 1; i < 4; ++i, corner = TriangleMesh::next(corner))
      start.lengths2[i] = (mesh.position(mesh.from(corner)) - middle).squaredNorm();
    for (int i = 0; i < 3; ++i) start.corner[i] = mesh.position(mesh.from(h))[i];
    greatest2 = std::max(greatest2, *std::max_element(start.lengths2.begin(), start.lengths2.end()));
    starts.push_back(start);
  }
  sort_starts(starts, 0, starts.size(), 0, greatest2);
  std::vector<int> halfedges;
  for (const Start& start : starts) halfedges.push_back(start.halfedge);
  return halfedges;
}

}  // namespace

CanonicalOrder canonical_order(const TriangleMesh& mesh, const RunContext& context) {
  CanonicalOrder order;
  order.halfedge.reserve(mesh.halfedge_count());
  std::vector<char> seen_face(mesh.face_count(), 0), seen_vertex(mesh.vertex_count(), 0);
  const auto add = [&](int h) {
    seen_face[h / 3] = 1;
    for (int i = 0; i < 3; ++i, h = TriangleMesh::next(h)) {
      order.halfedge.push_back(h);
      if (seen_vertex[mesh.from(h)]) continue;
      seen_vertex[mesh.from(h)] = 1;
      order.vertex.push_back(mesh.from(h));
    }
  };
  for (const int start : starts_of(mesh, context)) {
    std::size_t next = order.halfedge.size();
    for (add(start); next < order.halfedge.size(); ++next) {
      context.checkpoint_at(next);
      const int o = mesh.opposite(order.halfedge[next]);
      if (o >= 0 && !seen_face[o / 3]) add(o);
    }
  }
  return order;
}

TriangleMesh reordered(const TriangleMesh& mesh, const CanonicalOrder& order, const RunContext& context) {
  std::vector<int> new_vertex(mesh.vertex_count(), -1), new_halfedge(mesh.halfedge_count(), -1), opposite;
  std::vector<Vector3> positions;
  for (const int v : order.vertex) {
    new_vertex[v] = static_cast<int>(positions.size());
    positions.push_back(mesh.position(v));
  }
  for (std::size_t h = 0; h < order.halfedge.size(); ++h) new_halfedge[order.halfedge[h]] = static_cast<int>(h);
  std::vector<std::array<int, 3>> faces(mesh.face_count());
  for (std::size_t h = 0; h < order.halfedge.size(); ++h) {
    context.checkpoint_at(h);
    const int o = mesh.opposite(order.halfedge[h]);
    faces[h / 3][h % 3] = new_vertex[mesh.from(order.halfedge[h])];
    opposite.push_back(o < 0 ? -1 : new_halfedge[o]);
  }
  return TriangleMesh(std::move(positions), std::move(faces), std::move(opposite));
}

}  // namespace hybrid_quad
