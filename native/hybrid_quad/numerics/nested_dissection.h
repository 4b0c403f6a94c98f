#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/base/types.h"
#include "hybrid_quad/numerics/sparse_matrix.h"

namespace hybrid_quad {

/// An order of elimination in which parts of a mesh come before what separates them (George 1973), as a forest: a part's
/// own unknowns are eliminated together, after those of its children.
struct EliminationForest {
  struct Part {
    int begin = 0, end = 0;  ///< range of `order`
    std::vector<int> children;
  };
  std::vector<Part> parts;  ///< children before their parents
  std::vector<int> order;   ///< unknowns in the order of elimination
};

/// Halves the unknowns again and again, and each time takes out those on one side that are coupled with the other: by planes,
/// and where a plane meets too many (sheets, springs) by the number of couplings from one end, if that takes out fewer. What
/// is not connected comes apart without any: the two coordinates of a grid mix at cones alone.
/// \param lower   lower triangle; only its pattern counts
/// \param places  where the unknowns are: couplings should be short
EliminationForest nested_dissection(const SparseMatrix& lower, const std::vector<Vector3>& places, const RunContext& context);

}  // namespace hybrid_quad
