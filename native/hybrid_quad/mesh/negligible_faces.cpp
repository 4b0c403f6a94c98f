#include "hybrid_quad/mesh/negligible_faces.h"

#include <array>
#include <cmath>
#include <utility>

#include "hybrid_quad/mesh/degenerate_faces.h"

namespace hybrid_quad {

namespace {

struct Part {
  std::vector<int> faces;
  double area = 0;
  bool has_area = false;
  Vector3 low = Vector3::Constant(HUGE_VAL), high = Vector3::Constant(-HUGE_VAL);
};

std::vector<Part> parts_of(const TriangleMesh& mesh) {
  std::vector<Part> parts;
  std::vector<char> is_seen(mesh.face_count(), 0);
  for (int seed = 0; seed < mesh.face_count(); ++seed) {
    if (is_seen[seed]) continue;
    Part part;
    part.faces.push_back(seed);
    is_seen[seed] = 1;
    for (std::size_t i = 0; i < part.faces.size(); ++i) {
      const int f = part.faces[i];
      const auto& t = mesh.face(f);
      const Vector3 &a = mesh.position(t[0]), &b = mesh.position(t[1]), &c = mesh.position(t[2]);
      part.area += 0.5 * (b - a).cross(c - a).norm();
      part.has_area = part.has_area || !has_no_area(a, b, c);
      part.low = part.low.cwiseMin(a).cwiseMin(b).cwiseMin(c);
      part.high = part.high.cwiseMax(a).cwiseMax(b).cwiseMax(c);
      for (int h = 3 * f; h < 3 * f + 3; ++h) {
        const int o = mesh.opposite(h);
        if (o < 0 || is_seen[o / 3]) continue;
        is_seen[o / 3] = 1;
        part.faces.push_back(o / 3);
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

std::vector<Weight> weight_of_faces(const TriangleMesh& mesh) {
  const std::vector<Part> parts = parts_of(mesh);
  double whole = 0;
  for (const Part& part : parts) whole += part.area;
  std::vector<Weight> weight(mesh.face_count(), Weight::kCounts);
  for (const Part& part : parts) {
    const bool is_tiny = part.area < kLeastShare * whole, is_thin = part.area < kLeastWidth * (part.high - part.low).squaredNorm();
    if (part.has_area && !is_tiny && !is_thin) continue;
    for (const int f : part.faces) weight[f] = !part.has_area ? Weight::kNoArea : is_tiny ? Weight::kTiny : Weight::kThin;
  }
  return weight;
}

CountingFaces faces_that_count(const TriangleMesh& mesh, const std::vector<Weight>& weight) {
  CountingFaces kept;
  std::vector<int> new_vertex(mesh.vertex_count(), -1), new_face(mesh.face_count(), -1), opposite;
  std::vector<Vector3> positions;
  std::vector<std::array<int, 3>> faces;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (weight[f] != Weight::kCounts) continue;
    new_face[f] = static_cast<int>(kept.face.size());
    kept.face.push_back(f);
    for (const int v : mesh.face(f)) new_vertex[v] = 0;
  }
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (new_vertex[v] == 0) {
      new_vertex[v] = static_cast<int>(positions.size());
      kept.vertex.push_back(v);
      positions.push_back(mesh.position(v));
    }
  for (const int f : kept.face) {
    faces.push_back({new_vertex[mesh.face(f)[0]], new_vertex[mesh.face(f)[1]], new_vertex[mesh.face(f)[2]]});
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int o = mesh.opposite(h);
      opposite.push_back(o < 0 ? -1 : 3 * new_face[o / 3] + o % 3);
    }
  }
  kept.mesh = TriangleMesh(std::move(positions), std::move(faces), std::move(opposite));
  return kept;
}

}  // namespace hybrid_quad
