#pragma once

#include <cstdint>
#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// A surface cut open so that every piece is a disk without cones inside, where grid coordinates are functions. Inside the
/// surface the cut has no end that is not a cone.
struct DiskCut {
  std::vector<int> node;          ///< 3 #F: which vertex of the cut surface the corner at from(h) is
  std::vector<int> node_vertex;   ///< which vertex of the surface a node is a copy of
  std::vector<int> cut;           ///< one half-edge of every edge that is cut; the boundary's are not among them
  std::vector<int> piece_node;    ///< a node of every piece
};

/// \param matching  3 #F, combed: 0 across a spanning tree of the dual graph (FrameField)
DiskCut cut_to_disks(const TriangleMesh& mesh, const std::vector<std::uint8_t>& matching);

}  // namespace hybrid_quad
