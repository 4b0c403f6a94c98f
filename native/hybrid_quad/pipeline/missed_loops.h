#pragma once

#include <vector>

#include "hybrid_quad/pipeline/component.h"
#include "hybrid_quad/pipeline/hard_guides.h"
#include "hybrid_quad/pipeline/size_plan.h"

namespace hybrid_quad {

/// Loop guides whose chain of edges is farther away than GuideFit::kNear.
struct MissedLoops {
  double excess = 0;        ///< by how much all of them together (mean edge lengths of their chains)
  std::vector<int> places;  ///< of each, the vertex of the plan's mesh on it that is farthest, unless a corner is near
};

MissedLoops missed_loops(const ComponentPlan& plan, const HardGuides& guides, const ComponentResult& result);

}  // namespace hybrid_quad
