#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/numerics/sparse_matrix.h"

namespace hybrid_quad {

/// A point of a Catmull-Clark surface: (u, v) in [0, 1]^2 of a quad, u from its corner 0 to 1, v from 0 to 3.
struct LimitPlace {
  int quad = 0;
  double u = 0, v = 0;
};

/// The place at `fraction` along side i of a quad, from corner i to i + 1.
LimitPlace place_on_side(int quad, int side, double fraction);

/// #places x #V: weights that give points of the Catmull-Clark limit surface from the mesh's vertices (OpenSubdiv's limit
/// stencils on an adaptive refinement). Feature edges are infinitely sharp creases, vertices of kind kCorner infinitely sharp;
/// the surface ends along the boundary's limit curve. The same for any number of threads.
/// \param places  ordered by quads
/// \pre `mesh` is valid (violations_of) \throws InternalError if OpenSubdiv refuses the mesh
SparseMatrix limit_weights(const QuadMesh& mesh, const std::vector<LimitPlace>& places, const RunContext& context);

}  // namespace hybrid_quad
