#pragma once

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// No valid mesh of quads (violations_of) that is connected and of this topology has fewer quads: there would not be enough pairs of
/// vertices for its edges, or vertices with fewer than three quads.
/// \param euler_characteristic  V - E + F  \param loops  of the boundary
int fewest_quads(int euler_characteristic, int loops);
int fewest_quads(const TriangleMesh& component);

/// How many it should have to be a mesh of good quads at all: some, and more for every handle and hole.
double quads_for_topology(const TriangleMesh& mesh);

/// A plan is for as many at the least: for half of quads_for_topology where the surface has no handles, as these, if small, are paid for by others.
double least_to_plan(const TriangleMesh& mesh);

}  // namespace hybrid_quad
