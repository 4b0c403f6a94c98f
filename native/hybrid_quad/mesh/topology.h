#pragma once

#include <vector>

#include "hybrid_quad/mesh/quad_complex.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// What an oriented surface is up to homeomorphism, if it is connected (classification of compact surfaces: the other two fix its genus).
struct Topology {
  int pieces = 0;                ///< connected ones
  int euler_characteristic = 0;  ///< V - E + F, vertices no face uses not counted
  int border_loops = 0;          ///< closed curves that the border consists of

  bool operator==(const Topology& o) const {
    return pieces == o.pieces && euler_characteristic == o.euler_characteristic && border_loops == o.border_loops;
  }
  bool operator!=(const Topology& o) const { return !(*this == o); }
};

/// Closed curves that the border consists of, 0 for a closed surface.
int border_loops_of(const TriangleMesh& mesh);

Topology topology_of(const TriangleMesh& mesh);
Topology topology_of(const QuadComplex& complex);
/// Of an indexed mesh, which knows sides by their ends alone: a hole with two sides is none there.
/// \throws InternalError as complex_of_quads
Topology topology_of(const QuadMesh& mesh);

/// Of every connected piece, in ascending order: tells apart what their sum cannot, as a sphere and a ring from a sphere.
/// \pre no vertex is in two pieces
std::vector<int> euler_characteristics_of_pieces(const TriangleMesh& mesh);
/// \throws InternalError as complex_of_quads
std::vector<int> euler_characteristics_of_pieces(const QuadMesh& mesh);

}  // namespace hybrid_quad
