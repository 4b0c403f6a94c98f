#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Unit normals of faces, by which creases are told. A sliver's own one is rounding noise: it takes that of a face beside
/// it, or beside the slivers about it, from which the longest edges lead to it.
/// \returns #F
std::vector<Vector3> crease_normals(const TriangleMesh& mesh);

}  // namespace hybrid_quad
