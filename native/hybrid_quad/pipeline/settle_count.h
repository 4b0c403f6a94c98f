#pragma once

#include "hybrid_quad/pipeline/component.h"

namespace hybrid_quad {

/// Brings the quads of a component near a wanted number, where no try at an extraction did or where passes for
/// flawed quads took more: rows of quads, then single ones, are taken out or put in. Nothing is kept that has more flawed quads
/// than before. Not where sizes differ by direction, nor with hard guides.
/// \param plan  as planned, before passes refined it
void settle_count(const ComponentPlan& plan, double wanted, const SurfaceIndex& whole, const Wishes& wishes, const RemeshOptions& options,
                  ComponentResult& result, StageClock& clock, const RunContext& context);

}  // namespace hybrid_quad
