#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Faces of regions between edges by angle that are too small for a quad, along the surface about them and across it: folds
/// between slivers, or letters. What stands up from the surface, as the walls of a step, is none.
/// \param normals   #F, unit
/// \param barriers  3 #F: edges between regions, both sides alike
/// \param quad      edge length of a quad, scene units
/// \return #F
std::vector<char> small_facets(const TriangleMesh& mesh, const std::vector<Vector3>& normals, const std::vector<char>& barriers,
                               double quad);

}  // namespace hybrid_quad
