#pragma once

#include <optional>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/pipeline/size_plan.h"
#include "hybrid_quad/pipeline/wishes.h"

namespace hybrid_quad {

/// What of a surface has to agree with each quad of a result.
Agreement least_agreement(const SurfaceIndex& whole);

/// Quads that are flawed, and with these some that only just pass that test (flawed_quads): where little of the surface
/// agrees with them, or only a sheet in the same place. Ascending.
struct Doubts {
  std::vector<int> flawed, doubtful;
};

/// How the extracted quads of a component are improved and made fit for mirroring.
class Finishing {
 public:
  /// \param whole  the surface that the component is part of
  Finishing(const ComponentPlan& plan, const SurfaceIndex& whole, const Wishes& wishes, const RemeshOptions& options);
  Finishing(const Finishing&) = delete;
  Finishing& operator=(const Finishing&) = delete;

  const ImproveOptions& options() const { return improve_; }
  Improved improve_once(const QuadMesh& mesh, const RunContext& context) const;
  /// \param first  what improve_once made of the same quads, if it did
  ImproveReport improve(QuadMesh& mesh, const RunContext& context, std::optional<Improved> first = std::nullopt) const;
  /// The last resort for flawed quads (split_flawed_quads). \returns sides split
  int split_flawed(QuadMesh& mesh, const RunContext& context) const;
  /// What is left to do where no side to split helps (refine_flawed_quads). \returns places refined
  int refine_flawed(QuadMesh& mesh, const RunContext& context) const;
  /// Tips that quads end short of (reach_cut_parts). \returns places reached
  int reach_cut_parts(QuadMesh& mesh, const RunContext& context) const;
  /// Edges above the sharp angle that are no features (follow_creases). \returns places where sides are nearer to them
  int follow_creases(QuadMesh& mesh, const RunContext& context) const;
  /// Places around quads of poor shape (raise_shapes). \returns their number
  int raise_shapes(QuadMesh& mesh, const RunContext& context) const;
  /// Sides of quads that no places put right (split_folded_quads). \returns their number
  int split_folded(QuadMesh& mesh, const RunContext& context) const;
  /// By raise_shapes and split_folded so far, that would have taken too long (ImproveOptions::most_boxes_opened).
  int ended_searches() const { return ended_searches_; }
  /// What the improvement made of the quads at mirror planes must still be fit for mirroring.
  void make_mirrorable(QuadMesh& mesh, const RunContext& context) const;

  std::vector<int> flawed(const QuadMesh& mesh, int threads) const;
  Doubts doubts(const QuadMesh& mesh, int threads) const;

 private:
  void settle_features(QuadMesh& mesh) const;

  const ComponentPlan& plan_;
  const SurfaceIndex& whole_;
  const RemeshOptions& asked_;
  GuideMap guides_;
  ImproveOptions improve_;
  mutable int ended_searches_ = 0;
  mutable FutileMending futile_shapes_;  ///< of raise_shapes
};

}  // namespace hybrid_quad
