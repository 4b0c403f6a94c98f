#pragma once

#include <vector>

#include "hybrid_quad/mesh/quad_complex.h"
#include "hybrid_quad/singular_patches/discrete_gradient.h"
#include "hybrid_quad/singular_patches/patch_border.h"

namespace hybrid_quad {

/// The quasi-dual complex of a discrete gradient, one quad per critical edge, glued cell by cell of the
/// Morse-Smale complex.
struct MorseSmaleComplex {
  QuadComplex quads;           ///< border nodes are corners (anchor: node id), `curve` is the arc's id
  std::vector<int> extremum;   ///< #V of quads: the vertex of the patch mesh
  std::vector<double> saddle;  ///< #Q: value of the saddle
};

/// Gluing needs no vertex pairs: a quad edge is a sector between two descending paths that arrive at a
/// minimum one after the other, so walking around the tree of paths of every minimum glues all sides (corners
/// at a minimum: 0 and 2). \param patch  no edge joins two border minima or two border maxima \throws
/// InternalError if the maxima that ascending paths reach are not the orbits of the gluing (a bug)
MorseSmaleComplex morse_smale_complex(const PatchSurface& patch, const PatchBorder& border,
                                      const std::vector<int>& rank, const DiscreteGradient& gradient,
                                      const RunContext& context);

}  // namespace hybrid_quad
