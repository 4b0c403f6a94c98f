#include "hybrid_quad/mesh/first_halfedge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

namespace hybrid_quad {

namespace {

constexpr double kSame = 1e-7;         ///< of the greatest: squared lengths that differ by less are the same
constexpr std::size_t kMostFaces = 256;  ///< about each half-edge, looked at to tell it from others

/// Leaves those of the greatest value, and of as great ones. \param slack  what is less by no more is as great
template <class Value>
void keep_greatest(std::vector<int>& list, double slack, const Value& value) {
  if (list.size() < 2) return;
  std::vector<double> values;
  for (std::size_t i = 0; i < list.size(); ++i) values.push_back(value(i));
  const double least = *std::max_element(values.begin(), values.end()) - slack;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size(); ++i)
    if (values[i] >= least) list[kept++] = list[i];
  list.resize(kept);
}

/// The vertices of the first faces, breadth first from a half-edge.
std::vector<int> vertices_around(const TriangleMesh& mesh, int start, std::size_t most_faces) {
  std::vector<int> halfedges, vertices;
  std::unordered_set<int> seen;
  const auto add = [&](int h) {
    seen.insert(h / 3);
    for (int i = 0; i < 3; ++i, h = TriangleMesh::next(h)) {
      halfedges.push_back(h);
      vertices.push_back(mesh.from(h));
    }
  };
  add(start);
  for (std::size_t next = 0; next < halfedges.size() && seen.size() < most_faces; ++next) {
    const int o = mesh.opposite(halfedges[next]);
    if (o >= 0 && !seen.count(o / 3)) add(o);
  }
  return vertices;
}

std::array<double, 9> coordinates_of(const TriangleMesh& mesh, int h) {
  std::array<double, 9> out;
  for (int i = 0; i < 3; ++i, h = TriangleMesh::next(h))
    for (int k = 0; k < 3; ++k) out[3 * i + k] = mesh.position(mesh.from(h))[k];
  return out;
}

}  // namespace

Vector3 middle_of(const TriangleMesh& mesh, const std::vector<int>& faces) {
  const Vector3 reference = mesh.position(mesh.face(faces.front())[0]);  // what is far from the origin loses no digits
  Vector3 moment = Vector3::Zero();
  double area = 0;
  for (const int f : faces) {
    const auto& t = mesh.face(f);
    const double a = mesh.area(f);
    area += a;
    moment += a / 3 * (mesh.position(t[0]) + mesh.position(t[1]) + mesh.position(t[2]) - 3 * reference);
  }
  return area > 0 ? Vector3(reference + moment / area) : reference;
}

int first_halfedge(const TriangleMesh& mesh, const std::vector<int>& faces, const RunContext& context) {
  const auto ask = [&] {
    if (faces.size() > 65536) context.checkpoint();  // small ones are many: whoever goes through them asks
  };
  double longest = 0;
  for (const int f : faces)
    for (int h = 3 * f; h < 3 * f + 3; ++h) longest = std::max(longest, mesh.edge_vector(h).squaredNorm());
  std::vector<int> list;
  for (const int f : faces)
    for (int h = 3 * f; h < 3 * f + 3; ++h)
      if (mesh.edge_vector(h).squaredNorm() >= (1 - kSame) * longest) list.push_back(h);

  ask();
  const Vector3 middle = middle_of(mesh, faces);
  ask();
  const auto distance2 = [&](int v) { return (mesh.position(v) - middle).squaredNorm(); };
  double farthest = 0;
  for (const int f : faces)
    for (const int v : mesh.face(f)) farthest = std::max(farthest, distance2(v));
  ask();
  const double slack = kSame * farthest;
  keep_greatest(list, slack, [&](std::size_t i) { return distance2(mesh.from(list[i])); });
  keep_greatest(list, slack, [&](std::size_t i) { return distance2(mesh.to(list[i])); });

  // Those that are left are compared by what is around them, at no more than a few times the cost of looking at all faces.
  const std::size_t most = std::clamp<std::size_t>((4 * faces.size() + 10000) / list.size(), 1, kMostFaces);
  std::vector<std::vector<int>> around(list.size() > 1 ? list.size() : 0);
  for (std::size_t i = 0; i < around.size(); ++i) around[i] = vertices_around(mesh, list[i], most);
  std::vector<int> which(around.size());
  for (std::size_t i = 0; i < which.size(); ++i) which[i] = static_cast<int>(i);
  for (std::size_t k = 0; which.size() > 1 && k < 3 * most; ++k)
    keep_greatest(which, slack, [&](std::size_t i) {
      const std::vector<int>& vertices = around[which[i]];
      return k < vertices.size() ? distance2(vertices[k]) : -1.0;
    });
  if (which.empty()) return list.front();
  int best = list[which.front()];
  for (const int i : which)
    if (coordinates_of(mesh, best) < coordinates_of(mesh, list[i])) best = list[i];
  return best;
}

}  // namespace hybrid_quad
