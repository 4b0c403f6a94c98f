#pragma once

#include <memory>

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

/// A pass over a component that can be looked at half-way, where one of several is to be gone on with (docs/decisions/0057).
class ComponentPass {
 public:
  /// All that is given outlives the pass. \param whole  the surface that the component is part of
  ComponentPass(const ComponentPlan& plan, const SurfaceIndex& whole, const Wishes& wishes, const HardGuides& guides,
                const RemeshOptions& options, const PassSettings& settings);
  ComponentPass(ComponentPass&&) noexcept;
  ComponentPass& operator=(ComponentPass&&) noexcept;
  ~ComponentPass();

  /// The quads of its first try, improved once if quads are to be improved. \pre called once at most, before complete()
  /// \throws InternalError as run_pass
  const QuadMesh& sketch(StageClock& clock, const RunContext& context);
  /// run_pass, from where the sketch left off if there was one. \pre called once
  ComponentResult complete(StageClock& clock, const RunContext& context);

 private:
  friend ComponentPreview preview_pass(const ComponentPlan&, const SurfaceIndex*, const Wishes&, const HardGuides&,
                                       const RemeshOptions&, const PassSettings&, StageClock&, const RunContext&);
  static ComponentPreview preview(const ComponentPlan& plan, const SurfaceIndex* whole, const Wishes& wishes,
                                  const HardGuides& guides, const RemeshOptions& options, const PassSettings& settings,
                                  StageClock& clock, const RunContext& context);
  class Stages;
  std::unique_ptr<Stages> stages_;
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
