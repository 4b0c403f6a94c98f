#include "hybrid_quad/mesh/vertices_on_faces.h"

#include <algorithm>
#include <array>

namespace hybrid_quad {

namespace {

constexpr double kTouch = 1e-9;  ///< of the mesh's size: what is less is rounding

/// Whether face g is on the other side of a face of v's.
bool is_behind_face_of(const TriangleMesh& mesh, int g, int v) {
  for (int h = 3 * g; h < 3 * g + 3; ++h) {
    const int o = mesh.opposite(h);
    if (o < 0) continue;
    const std::array<int, 3>& t = mesh.face(o / 3);
    if (std::find(t.begin(), t.end(), v) != t.end()) return true;
  }
  return false;
}

}  // namespace

std::vector<int> vertices_on_faces(const SurfaceIndex& index, const std::vector<int>& source) {
  const TriangleMesh& mesh = index.mesh();
  const Vector3 room = Vector3::Constant(kTouch);
  std::vector<int> found;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vector3& p = mesh.position(v);
    const bool is_on_face = index.any_in_box(p - room, p + room, [&](int g) {
      const std::array<int, 3>& t = mesh.face(g);
      for (const int w : t)
        if (source[w] == source[v] || mesh.position(w) == p) return false;
      const Vector3 nearest = nearest_on_triangle(p, mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]));
      return (nearest - p).norm() <= kTouch && !is_behind_face_of(mesh, g, v);
    });
    if (is_on_face) found.push_back(v);
  }
  return found;
}

}  // namespace hybrid_quad
