#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/sequence_search.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Sequences of up to three diagonal collapses and edge rotations where quads are straight at a feature, each kept only if
/// the quads around are not worse afterwards (locally smoothed). \param memory  of earlier calls with the same mesh
/// \returns number of moves made
int straighten_features(Workpiece& piece, Smoother& smoother, SequenceMemory& memory, const RunContext& context);

/// The same around every irregular vertex, up to two moves each.
int improve_valences(Workpiece& piece, Smoother& smoother, SequenceMemory& memory, const RunContext& context);

/// Moves around quads of bad shape that make the worst quad there clearly better, even where valences suffer a little.
int improve_shapes(Workpiece& piece, Smoother& smoother, const RunContext& context);

}  // namespace hybrid_quad
