#pragma once

#include <vector>

#include "hybrid_quad/pipeline/hard_guides.h"
#include "hybrid_quad/pipeline/size_plan.h"

namespace hybrid_quad {

// Features that a plan goes without: by angle, counted in given_way (docs/decisions/0006, 0007, 0014), and at the very last marked
// ones and hard guides, in marks_given_way (0047). Boundaries and curves with an asked count always stay. Lengths are to be planned anew after each.

/// A crease with slivers along it is found as two lines by angle, on top of each other: one of them stays. None does where what is
/// left lies on top of itself, as the rim of a flap thin as a hair.
/// \param length  the usual edge length (scene units)
void merge_double_lines(ComponentPlan& plan, double length, const RunContext& context);

/// Where features must have nearly as many edges as there are to be quads, takes as few of them away as make room.
/// \returns whether any
bool make_room(ComponentPlan& plan, const RunContext& context);

/// Where more than a few features are shorter than quads, or room had to be made, takes away what keeps these from having good shapes. Whether they do is to
/// be seen: where features are all that a thin part has, it comes out the worse. \returns whether any
bool make_room_for_shapes(ComponentPlan& plan, const RunContext& context);

/// Takes away all features that are there by their angle. \returns whether any
bool let_angles_go(ComponentPlan& plan);

/// Takes away the features that pass within an edge of some places. \returns whether any
bool make_room_at(ComponentPlan& plan, const std::vector<Vector3>& places);

/// Takes away the features that pass near some places, those of marked edges too: a valid mesh is worth more than they are.
/// \param reach  how near, in the edges that features there need \returns whether any
bool make_room_in_marks_at(ComponentPlan& plan, const std::vector<Vector3>& places, double reach);

/// Takes away what asks for edges of its own: hard guides, but not the sharp and the marked edges on which they lie, and asked counts
/// along curves. \returns whether there was any
bool let_exact_wishes_go(ComponentPlan& plan, const HardGuides& guides);

}  // namespace hybrid_quad
