#pragma once

#include <vector>

#include "hybrid_quad/spanning_parameterization/closed_rows.h"
#include "hybrid_quad/spanning_parameterization/row_moves.h"

namespace hybrid_quad {

/// Routes, by index, that stand or fall together.
using RowCycle = std::vector<int>;

/// Splits routes into sets that reach each site an even number of times, as small as a shortest-cycle search makes them: in
/// the graph of sites (with the boundary as one more), routes are edges, and such a set is a cycle. A route that is on none
/// is in no set.
std::vector<RowCycle> cycles_of(const std::vector<RowRoute>& routes);

/// The generating loops around which a cycle changes whether the jumps' sums are even.
GeneratingLoops::Set flipped_by(const RowCycle& cycle, const std::vector<RowRoute>& routes, const GeneratingLoops& loops);

/// Few and small cycles, by index, without which the others flip no loop (Gaussian elimination over GF(2), small cycles first).
/// \param flips  of each cycle: the loops it flips
std::vector<int> cycles_to_leave_out(const std::vector<RowCycle>& cycles, const std::vector<GeneratingLoops::Set>& flips);

}  // namespace hybrid_quad
