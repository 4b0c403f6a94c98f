#pragma once

#include <vector>

#include "hybrid_quad/mesh/mesh_builder.h"

namespace hybrid_quad {

/// What is unusual about a mesh that can be remeshed, and stays as it is, because only its owner knows whether it is meant:
/// self_intersection (faces), touching_vertex (at one place with another, without being joined to it), far_vertex.
std::vector<Defect> oddities_of(const BuiltMesh& built);

/// The touching_vertex of these alone: who welds by place, which files of triangles do, gets another surface than the built one.
void note_touching_vertices(const BuiltMesh& built, std::vector<Defect>& defects);

}  // namespace hybrid_quad
