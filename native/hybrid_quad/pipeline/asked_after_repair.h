#pragma once

#include <string>
#include <vector>

#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {

/// What is asked of edges and vertices of the input, asked of those of the built mesh that stand for them: the vertices that others
/// were merged into, and the chains of edges that edges became where T-junctions split them. Edges of parts that were left out
/// because others lie there are those of the others, as are the guides of polygons.
/// Of guides at vertices that were merged the first that says anything stays, of densities the one farthest from 1.
/// \param warnings  gets how many marked edges no edge of the built mesh stands for
RemeshOptions asked_after_repair(const PolygonSoup& soup, const BuiltMesh& built, const RemeshOptions& asked,
                                 std::vector<std::string>& warnings);

}  // namespace hybrid_quad
