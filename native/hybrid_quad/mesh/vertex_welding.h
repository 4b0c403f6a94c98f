#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// For every vertex the first one at the same place, exactly.
std::vector<int> places_of(const std::vector<Vector3>& positions);

/// For every vertex the vertex it is to be merged into (itself if none). Ends of open edges are merged where another open
/// edge lies exactly on them, so cracks of an unwelded mesh close while sheets that merely touch stay apart.
/// \param open  what open_edges() gives
std::vector<int> welded_vertices(const std::vector<Vector3>& positions, const std::vector<std::array<int, 2>>& open);

/// The same for seams whose sides differ by rounding, as where a full turn does not end exactly where it began: two open edges that run opposite
/// ways, both their ends a ten-thousandth of their length apart at most. \param positions  of a mesh whose diagonal is 1
std::vector<int> nearly_welded_seams(const std::vector<Vector3>& positions, const std::vector<std::array<int, 2>>& open);

/// The same for a soup of loose triangles whose corners differ by rounding: corners nearer than `tolerance` merge.
std::vector<int> nearly_welded_vertices(const std::vector<Vector3>& positions, double tolerance);

/// Directed edges with one face only, in the order of their vertices.
std::vector<std::array<int, 2>> open_edges(const std::vector<std::array<int, 3>>& faces, std::size_t* edge_count = nullptr);

/// Share of edges that have one face only.
double open_edge_share(const std::vector<std::array<int, 3>>& faces);

}  // namespace hybrid_quad
