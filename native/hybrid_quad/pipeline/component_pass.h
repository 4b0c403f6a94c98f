#pragma once

#include "hybrid_quad/pipeline/component.h"

namespace hybrid_quad {

/// What a pass is for, and what gives way in it.
enum class PassKind {
  kFirst,            ///< features and asked lengths as planned, tries at the number of quads
  kAgain,            ///< likewise; the number is settled afterwards
  kWithoutFeatures,  ///< likewise, and features by angle give way around flawed quads of earlier passes
  kAsNeeded,         ///< as many quads as it takes; the number is settled afterwards
};

/// Settings of one whole pass over a component.
struct PassSettings {
  double quads_factor = 1.0;
  double curl_weight = 1e-5;
  PassKind kind = PassKind::kFirst;
  bool is_rough = false;  ///< the number is met afterwards, quad by quad
  bool is_doubtful = false;  ///< so that few tries at the number have to do
};

/// All stages from the working surface to the improved quads, with tries at the number of quads.
/// \param whole  the surface that the component is part of
/// \throws InternalError where a stage's promise broke and no way around it was left
ComponentResult run_pass(const ComponentPlan& plan, const SurfaceIndex& whole, const Wishes& wishes, const HardGuides& guides,
                         const RemeshOptions& options, const PassSettings& settings, StageClock& clock, const RunContext& context);

/// Its first stages: to the field, scaled to the asked lengths, or to the quads of one try.
/// \param whole  the surface that the component is part of; null: no quads
ComponentPreview preview_pass(const ComponentPlan& plan, const SurfaceIndex* whole, const Wishes& wishes, const HardGuides& guides,
                              const RemeshOptions& options, const PassSettings& settings, StageClock& clock,
                              const RunContext& context);

}  // namespace hybrid_quad
