#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// A face whose height is lost in rounding next to its longest side.
bool has_no_area(const Vector3& a, const Vector3& b, const Vector3& c);

struct ResolvedMesh {
  TriangleMesh mesh;
  std::vector<int> vertex_source, face_source;  ///< ids in the given mesh
};

/// Removes faces without area by flipping the longest side of caps and collapsing the short side of needles, so that the
/// surface's topology and shape stay. At the border those that neither can remove are taken away, with vertices that no other face
/// has; but not caps with another side there than their longest, which would open a slit. What keeps parts together remains.
ResolvedMesh resolve_faces_without_area(const TriangleMesh& mesh);

std::vector<int> faces_without_area(const TriangleMesh& mesh);

}  // namespace hybrid_quad
