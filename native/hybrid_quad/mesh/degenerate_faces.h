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
/// surface's topology and shape stay. Faces that neither can remove remain.
ResolvedMesh resolve_faces_without_area(const TriangleMesh& mesh);

bool has_faces_without_area(const TriangleMesh& mesh);

}  // namespace hybrid_quad
