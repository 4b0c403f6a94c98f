#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "hybrid_quad/mesh/mesh_builder.h"

namespace hybrid_quad {

/// Vertices and faces of a Wavefront OBJ text (Wavefront Technologies, Advanced Visualizer Manual, appendix B1); all else in it is skipped.
///
/// Texture and normal indices of corners, and what follows a vertex's third coordinate, are left out. Vertex indices are 0-based, negative ones
/// resolved against the vertices above them; what the text has wrong stays out of range (0 becomes -1), for build_mesh() to tell.
/// \throws std::invalid_argument with the number of the line where a coordinate or an index is none
PolygonSoup parse_obj(std::string_view text);

/// An OBJ text of quads that parse_obj() reads to the same bits: 17 digits (Steele and White 1990).
std::string obj_text(const std::vector<Vector3>& positions, const std::vector<std::array<int, 4>>& quads);

}  // namespace hybrid_quad
