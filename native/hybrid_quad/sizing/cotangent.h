#pragma once

#include <algorithm>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Cotangent of the corner opposite to half-edge h, bounded for slivers.
inline double cotangent(const TriangleMesh& mesh, int h) {
  const Vector3 a = mesh.edge_vector(TriangleMesh::previous(h)), b = -mesh.edge_vector(TriangleMesh::next(h));
  const double sine = a.cross(b).norm(), cosine = a.dot(b);
  return sine > 0 ? std::clamp(cosine / sine, -1e3, 1e3) : 0;
}

}  // namespace hybrid_quad
