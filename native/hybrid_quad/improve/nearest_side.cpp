#include "hybrid_quad/improve/nearest_side.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hybrid_quad {

namespace {

/// \param least  squared distance of `best`
void look_at_quad(const EditMesh& mesh, const Vector3& p, int q, SidePlace& best, double& least) {
  constexpr double kLess = 1 - 1e-9, kMore = 1 + 1e-9;  // between them rounding alone decides
  const EditMesh::Quad& v = mesh.quad(q);
  for (int i = 0; i < 4; ++i) {
    const Vector3 along = mesh.positions[v[(i + 1) & 3]] - mesh.positions[v[i]], to = p - mesh.positions[v[i]];
    const double length = along.squaredNorm(), dot = to.dot(along);
    const double share = dot <= 0 ? 0.0 : dot >= length ? 1.0 : dot / length;
    const double distance = (to - share * along).squaredNorm();
    if (distance > kMore * least) continue;
    if (distance >= kLess * least && std::make_pair(q, i) > std::make_pair(best.quad, best.corner)) continue;
    least = std::min(least, distance);
    best.quad = q;
    best.corner = i;
    best.share = share;
  }
}

/// The same, seen from the first of the quads at the side.
SidePlace from_first_quad(const EditMesh& mesh, const SidePlace& place) {
  const EditMesh::Quad& v = mesh.quad(place.quad);
  const int a = v[place.corner], b = v[(place.corner + 1) & 3];
  for (const int q : mesh.quads_at(a)) {
    if (q >= place.quad) break;
    const EditMesh::Quad& w = mesh.quad(q);
    for (int i = 0; i < 4; ++i)
      if (w[i] == b && w[(i + 1) & 3] == a) return {q, i, 1 - place.share, place.distance};
  }
  return place;
}

template <class Vertices>
SidePlace nearest_of_quads_at(const Vertices& vertices, const EditMesh& mesh, const Vector3& p) {
  SidePlace best;
  double least = std::numeric_limits<double>::infinity();
  for (const int v : vertices)
    for (const int q : mesh.quads_at(v)) look_at_quad(mesh, p, q, best, least);
  best.distance = std::sqrt(least);
  return from_first_quad(mesh, best);
}

}  // namespace

SidePlace nearest_side(const EditMesh& mesh, const Vector3& p, const std::array<int, 4>& vertices) {
  return nearest_of_quads_at(vertices, mesh, p);
}

SidePlace nearest_side(const EditMesh& mesh, const Vector3& p, const std::array<int, 2>& vertices) {
  return nearest_of_quads_at(vertices, mesh, p);
}

}  // namespace hybrid_quad
