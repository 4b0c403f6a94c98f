#pragma once

#include "hybrid_quad/pipeline/component.h"

namespace hybrid_quad {

/// What settling the number weighs of a mesh.
struct SettledState {
  int quads = 0, flawed = 0, doubtful = 0, missed = 0;
  double error = 0;  ///< | log(quads / wanted) |
};

/// Whether a mesh may take another's place: no worse, and with a number that is off by no more than `most_error`. What has fewer
/// flawed quads may be as far off as what settling began with: a number a hundredth nearer is not worth one of them.
bool may_take_place_of(const SettledState& then, const SettledState& now, double most_error, double error_at_first);

/// Whether an error is worth improving a mesh for: not where next to nothing of what was missing is gained, as where features hold a
/// multiple of the quads asked for.
bool is_worth_improving(double error_then, double error_now);

/// Brings the quads of a component near a wanted number, where no try at an extraction did or where passes for
/// flawed quads took more: rows of quads, then single ones, are taken out or put in. Nothing is kept that has more flawed quads
/// than before. Not where sizes differ by direction, nor with hard guides.
/// \param plan  as planned, before passes refined it
void settle_count(const ComponentPlan& plan, double wanted, const SurfaceIndex& whole, const Wishes& wishes, const RemeshOptions& options,
                  ComponentResult& result, StageClock& clock, const RunContext& context);

}  // namespace hybrid_quad
