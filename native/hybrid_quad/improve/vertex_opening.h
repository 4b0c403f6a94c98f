#pragma once

#include <vector>

#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// The reverse of a diagonal collapse: a free vertex becomes two, with a quad between them and the ends of two of its edges.
struct VertexOpening {
  int vertex = -1;
  int first = -1, second = -1;  ///< the ends of the two edges
  int quads = 0;                ///< at the vertex from the first edge to the second, counterclockwise: these stay with it
};

/// All openings of v that leave both vertices at least three quads; none where v is not free, inside and off all features.
std::vector<VertexOpening> openings_of(const EditMesh& mesh, int v);
/// By how much the valence cost grows.
double opening_cost(const EditMesh& mesh, const VertexOpening& opening);
/// \pre one of openings_of() the mesh as it is
void open_vertex(Workpiece& piece, const VertexOpening& opening);

}  // namespace hybrid_quad
