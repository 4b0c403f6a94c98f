#pragma once

#include <vector>

#include "hybrid_quad/improve/edit_mesh.h"

namespace hybrid_quad {

/// The vertices in use, in groups of which no two are at one quad, so that those of a group can move at the same time: each
/// gets the first group that no neighbour is in.
std::vector<std::vector<int>> vertices_by_colour(const EditMesh& mesh);

}  // namespace hybrid_quad
