#pragma once

#include <vector>

#include "hybrid_quad/singular_patches/patch_quads.h"

namespace hybrid_quad {

/// One arc of a patch's border: a chain of border half-edges between two nodes, the patch on its left.
struct PatchArc {
  int id = -1;                 ///< PatchSurface::boundary_arc
  int from = -1, to = -1;      ///< mesh vertices: its nodes
  bool rising = false;         ///< from a minimum to a maximum
  std::vector<int> halfedges;  ///< in order
};

/// The border loops of a patch, each as its arcs in the order in which the border runs.
using PatchBorder = std::vector<std::vector<PatchArc>>;

/// \throws InternalError if an arc does not run between a minimum and a maximum, a loop has no node, an odd
/// number of arcs or fewer than four, or two arcs share an id
PatchBorder border_of(const PatchSurface& patch);

}  // namespace hybrid_quad
