#include "hybrid_quad/mesh/negligible_faces.h"

#include <cmath>

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

std::vector<Weight> weight_of_faces(const TriangleMesh& mesh, double least_share, double least_width) {
  const std::vector<Part> parts = parts_of(mesh);
  double whole = 0;
  for (const Part& part : parts) whole += part.area;
  std::vector<Weight> weight(mesh.face_count(), Weight::kCounts);
  for (const Part& part : parts) {
    const bool is_tiny = part.area < least_share * whole, is_thin = part.area < least_width * (part.high - part.low).squaredNorm();
    if (part.has_area && !is_tiny && !is_thin) continue;
    for (const int f : part.faces) weight[f] = !part.has_area ? Weight::kNoArea : is_tiny ? Weight::kTiny : Weight::kThin;
  }
  return weight;
}

}  // namespace hybrid_quad
