#pragma once

#include <vector>

#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// Vertices that lie on a face they are no corner of, in its middle or on one of its edges, as far as rounding can tell: where
/// sheets touch without being joined. One at the very place of a corner is not among them, nor is the tip of a face without
/// thickness. Of size 1 or so the mesh should be (see UnitFrame).
/// \param source  #V: vertices with the same one are copies of it, which meet where the mesh was cut
std::vector<int> vertices_on_faces(const SurfaceIndex& index, const std::vector<int>& source);

}  // namespace hybrid_quad
