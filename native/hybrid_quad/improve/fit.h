#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/smoother.h"

namespace hybrid_quad {

/// Moves free vertices along their normals so that the quads, not their corners, lie on the input: one step of a
/// weighted least-squares fit of the signed offset at 3 x 3 points of every quad. Vertices whose quads would get worse
/// than they should stay.
/// \param only  #V: the vertices that may move; null: all
void fit_to_input(Workpiece& piece, Smoother& smoother, const RunContext& context, const std::vector<char>* only = nullptr);

}  // namespace hybrid_quad
