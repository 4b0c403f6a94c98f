#pragma once

#include <vector>

#include "hybrid_quad/regular_quads/regular_quads.h"

namespace hybrid_quad {

/// Pieces outside every cell, joined across everything but features; patches in order of their first piece.
std::vector<std::vector<int>> find_patches(const RegularQuads& regular);

/// Patches grow over the cells beside their short border loops until every loop has at least four arcs: no quads that an indexed mesh
/// can hold fit into fewer. Two cells around the tip of a spike leave a loop of two arcs, and so do the two before them, as far
/// as the spike is no more than two cells around.
/// \returns cells given up; a loop on which there are none stays short
int grow_over_short_loops(RegularQuads& regular);

/// Gives up the cells beside some of the patches, so that these grow over their narrow places.
/// \param patches  all of them; \param which  indices of those that grow
/// \returns cells given up
int grow(RegularQuads& regular, const std::vector<std::vector<int>>& patches, const std::vector<int>& which);

}  // namespace hybrid_quad
