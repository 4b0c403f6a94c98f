#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/flaw_measure.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Takes quads out along their diagonals, also after an edge was turned, until no more are left than wanted: small ones first, and those
/// that leave better valences. Each stays out only if the quads around are not more flawed afterwards (locally smoothed), where
/// possible not worse in shape either. \returns quads taken out
int take_out_quads(Workpiece& piece, Smoother& smoother, const FlawMeasure& measure, const QuadNumber& number,
                   const RunContext& context);

/// The reverse: opens vertices, each to a quad between two of its edges, until there are as many quads as wanted.
/// \returns quads put in
int put_in_quads(Workpiece& piece, Smoother& smoother, const FlawMeasure& measure, const QuadNumber& number,
                 const RunContext& context);

}  // namespace hybrid_quad
