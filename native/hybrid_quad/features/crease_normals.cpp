#include "hybrid_quad/features/crease_normals.h"

#include <algorithm>
#include <queue>

namespace hybrid_quad {

namespace {

constexpr double kSliver = 1e-7;  ///< height over longest edge below which a face's normal is noise

double longest_edge(const TriangleMesh& mesh, int f) {
  return std::max({mesh.edge_length(3 * f), mesh.edge_length(3 * f + 1), mesh.edge_length(3 * f + 2)});
}

/// An edge over which a normal may go on to a sliver.
struct Way {
  double length;
  int halfedge;  ///< of the face that has the normal
  bool operator<(const Way& other) const { return length != other.length ? length < other.length : halfedge > other.halfedge; }
};

}  // namespace

std::vector<Vector3> crease_normals(const TriangleMesh& mesh) {
  std::vector<Vector3> normals(mesh.face_count());
  std::vector<char> is_sliver(mesh.face_count());
  for (int f = 0; f < mesh.face_count(); ++f) {
    const double longest = longest_edge(mesh, f);
    normals[f] = mesh.normal(f);
    is_sliver[f] = 2 * mesh.area(f) <= kSliver * longest * longest;
  }
  std::priority_queue<Way> ways;
  const auto lead_on = [&](int f) {
    for (int h = 3 * f; h < 3 * f + 3; ++h)
      if (!mesh.is_boundary(h) && is_sliver[mesh.opposite(h) / 3]) ways.push({mesh.edge_length(h), h});
  };
  for (int f = 0; f < mesh.face_count(); ++f)
    if (!is_sliver[f]) lead_on(f);
  while (!ways.empty()) {
    const int h = ways.top().halfedge, sliver = mesh.opposite(h) / 3;
    ways.pop();
    if (!is_sliver[sliver]) continue;
    is_sliver[sliver] = 0;
    normals[sliver] = normals[h / 3];
    lead_on(sliver);
  }
  return normals;
}

}  // namespace hybrid_quad
