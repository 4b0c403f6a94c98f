#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// A Forman gradient on a triangle mesh: every cell is critical or paired with one of the next or previous
/// dimension, and paths along pairs only descend (Robins, Wood and Sheppard 2011: pairs within lower stars).
struct DiscreteGradient {
  std::vector<int> down;  ///< #V: a half-edge of the edge the vertex is paired with; -1 for a minimum
  std::vector<int> up;    ///< #F: the half-edge of the face whose edge it is paired with; -1 for a maximum
  std::vector<int> critical_edges;  ///< saddles: one half-edge each, the lower of the two

  /// The half-edge that stands for the edge of h: the lower of its two.
  static int edge_of(const TriangleMesh& mesh, int h) {
    return mesh.opposite(h) < 0 || h < mesh.opposite(h) ? h : mesh.opposite(h);
  }
};

/// The fan of v: one half-edge for each edge at v in counterclockwise order; they leave v, but for the last
/// one of a border fan, which arrives.
void fan_of(const TriangleMesh& mesh, int v, std::vector<int>& halfedges);

/// \param rank           #V: order of the vertices, all different
/// \param forced_descent #V: a half-edge of the edge that v must be paired with, or -1 for the edge to the
/// lowest neighbour \pre no edge is a loop; a forced edge leads to a lower vertex
DiscreteGradient discrete_gradient(const TriangleMesh& mesh, const std::vector<int>& rank,
                                   const std::vector<int>& forced_descent);

}  // namespace hybrid_quad
