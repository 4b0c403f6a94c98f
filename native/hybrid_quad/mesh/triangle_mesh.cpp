#include "hybrid_quad/mesh/triangle_mesh.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/bucket_sort.h"

namespace hybrid_quad {

namespace {

/// Pairs the two half-edges of every edge by sorting, in O(F log F) and without a hash's order.
std::vector<int> pair_halfedges(const std::vector<std::array<int, 3>>& faces) {
  struct Entry {
    int low, high, halfedge;
  };
  std::vector<Entry> entries;
  entries.reserve(3 * faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int i = 0; i < 3; ++i) {
      const int a = faces[f][i], b = faces[f][(i + 1) % 3];
      entries.push_back({std::min(a, b), std::max(a, b), 3 * f + i});
    }
  bucket_sort(
      entries, [](const Entry& x) { return x.low; },
      [](const Entry& x, const Entry& y) { return std::tie(x.low, x.high, x.halfedge) < std::tie(y.low, y.high, y.halfedge); });
  std::vector<int> opposite(3 * faces.size(), -1);
  for (std::size_t i = 0; i < entries.size();) {
    std::size_t j = i + 1;
    while (j < entries.size() && entries[j].low == entries[i].low && entries[j].high == entries[i].high) ++j;
    if (j - i > 2) throw InternalError("mesh", "an edge has more than two faces");
    if (j - i == 2) {
      const int g = entries[i].halfedge, h = entries[i + 1].halfedge;
      if (faces[g / 3][g % 3] == faces[h / 3][h % 3]) throw InternalError("mesh", "two faces run along an edge in the same direction");
      opposite[g] = h;
      opposite[h] = g;
    }
    i = j;
  }
  return opposite;
}

}  // namespace

TriangleMesh::TriangleMesh(std::vector<Vector3> positions, std::vector<std::array<int, 3>> faces)
    : positions_(std::move(positions)), faces_(std::move(faces)), opposite_(pair_halfedges(faces_)) {
  index_vertices();
}

TriangleMesh::TriangleMesh(std::vector<Vector3> positions, std::vector<std::array<int, 3>> faces, std::vector<int> opposite)
    : positions_(std::move(positions)), faces_(std::move(faces)), opposite_(std::move(opposite)) {
  index_vertices();
}

TriangleMesh TriangleMesh::with_positions(std::vector<Vector3> positions) && {
  positions_ = std::move(positions);
  return std::move(*this);
}

void TriangleMesh::index_vertices() {
  outgoing_.assign(positions_.size(), -1);
  boundary_.assign(positions_.size(), 0);
  std::vector<int> corner_count(positions_.size(), 0);
  for (int h = 0; h < halfedge_count(); ++h) {
    const int v = from(h);
    ++corner_count[v];
    if (outgoing_[v] < 0 || opposite_[h] < 0) outgoing_[v] = h;
    if (opposite_[h] < 0) boundary_[v] = boundary_[to(h)] = 1;
  }
  for (int v = 0; v < vertex_count(); ++v) {
    if (outgoing_[v] < 0) continue;
    int fan = 0, h = outgoing_[v];
    do {
      ++fan;
      h = rotate_ccw(h);
    } while (h >= 0 && h != outgoing_[v] && fan <= corner_count[v]);
    if (fan != corner_count[v]) throw InternalError("mesh", "vertex " + std::to_string(v) + " has more than one fan");
  }
}

double TriangleMesh::total_area() const {
  double sum = 0;
  for (int f = 0; f < face_count(); ++f) sum += area(f);
  return sum;
}

double TriangleMesh::mean_edge_length() const {
  double sum = 0;
  for (int h = 0; h < halfedge_count(); ++h) sum += edge_length(h);
  return halfedge_count() ? sum / halfedge_count() : 0;
}

double TriangleMesh::diagonal() const {
  if (positions_.empty()) return 0;
  Vector3 low = positions_[0], high = positions_[0];
  for (const Vector3& p : positions_) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

double TriangleMesh::extent() const {
  Vector3 middle = Vector3::Zero();
  double total = 0;
  for (int f = 0; f < face_count(); ++f) {
    const auto& v = faces_[f];
    const double size = area(f);
    middle += size / 3 * (positions_[v[0]] + positions_[v[1]] + positions_[v[2]]);
    total += size;
  }
  if (!(total > 0)) return 0;
  middle /= total;
  double farthest2 = 0;
  for (const auto& t : faces_)
    for (const int v : t) farthest2 = std::max(farthest2, (positions_[v] - middle).squaredNorm());
  return 2 * std::sqrt(farthest2);
}

int TriangleMesh::euler_characteristic() const {
  int vertices = 0, boundary_edges = 0;
  for (const int h : outgoing_) vertices += h >= 0;
  for (const int o : opposite_) boundary_edges += o < 0;
  return vertices - (halfedge_count() + boundary_edges) / 2 + face_count();
}

}  // namespace hybrid_quad
