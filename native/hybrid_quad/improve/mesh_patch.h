#pragma once

#include <vector>

#include "hybrid_quad/mesh/quad_mesh.h"

namespace hybrid_quad {

/// Some quads of a mesh as a mesh of their own: what is tried there costs nothing for the rest.
struct MeshPatch {
  QuadMesh mesh;
  std::vector<int> quads, vertices, feature_edges;  ///< their numbers in the whole, in the order of `mesh`
};

/// \param quads  ascending
MeshPatch cut_patch(const QuadMesh& whole, const std::vector<int>& quads);

/// Puts a patch back in its place. Quads, vertices and feature edges that it was cut with keep their numbers, those that it has
/// got since come last.
void put_back(const MeshPatch& patch, QuadMesh& whole);

}  // namespace hybrid_quad
