#pragma once

#include <vector>

#include "hybrid_quad/mesh/mesh_builder.h"

namespace hybrid_quad {

/// What is unusual about a mesh that can be remeshed, and stays as it is, because only its owner knows whether it is meant:
/// self_intersection (faces), touching_vertex (at one place with another, or on a face, without being joined to it), far_vertex.
/// \param soup  what it was built from, for vertices whose faces went
std::vector<Defect> oddities_of(const BuiltMesh& built, const PolygonSoup& soup);

/// Of these the touching_vertex at one place with another vertex alone: who welds by place, which files of triangles do, gets
/// another surface than the built one.
void note_touching_vertices(const BuiltMesh& built, std::vector<Defect>& defects);

/// The far_vertex of these: vertices of the input that lie more than twenty times as far out as nine tenths of the others.
std::vector<int> far_vertices(const BuiltMesh& built);

}  // namespace hybrid_quad
