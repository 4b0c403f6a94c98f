#pragma once

#include <optional>

#include "hybrid_quad/pipeline/component.h"
#include "hybrid_quad/pipeline/finishing.h"

namespace hybrid_quad {

/// What is left to do for the quads of a component when no pass made all of them sound. Everything here keeps the mesh valid, counts what it does
/// in the result, and leaves no more quads flawed than there were. Not where guides follow the quads' edges, which keep their number.
class LastMeans {
 public:
  /// \param plan  that the result followed, before passes refined it  \param count  quads wanted
  /// \param whole  the surface that the component is part of  \param budget  what passes without marked edges take is taken from it
  LastMeans(const ComponentPlan& plan, double count, const SurfaceIndex& whole, const Wishes& wishes, const HardGuides& guides,
            const RemeshOptions& options, WorkBudget& budget, StageClock& clock, const RunContext& context);
  LastMeans(const LastMeans&) = delete;
  LastMeans& operator=(const LastMeans&) = delete;

  /// Sides of flawed quads are split.
  void split_flawed(ComponentResult& result) const;

  /// Against flawed quads, each only where what comes before it left some: sides are split, places are refined, marked edges give way.
  /// \param may_split  splits were not in vain on the very same mesh
  void put_flawed_right(ComponentResult& result, bool may_split);

  /// Against quads of poor shape, and whatever has no area even then.
  void improve_poor(ComponentResult& result) const;

 private:
  using Means = int (Finishing::*)(QuadMesh&, const RunContext&) const;
  int apply(Means means, const Finishing& finishing, ComponentResult& result) const;
  int apply_if_no_worse(Means means, const Finishing& finishing, ComponentResult& result) const;
  void let_marks_give_way(ComponentResult& result);
  Finishing finishing() const;
  bool keeps_numbers() const;

  const ComponentPlan& planned_;
  std::optional<ComponentPlan> fewer_marks_;  ///< that the result follows since marks gave way
  double count_;
  const SurfaceIndex& whole_;
  const Wishes& wishes_;
  const HardGuides& guides_;
  const RemeshOptions& options_;
  WorkBudget& budget_;
  StageClock& clock_;
  const RunContext& context_;
};

}  // namespace hybrid_quad
