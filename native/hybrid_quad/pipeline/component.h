#pragma once

#include "hybrid_quad/frame_field/frame_field.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/pipeline/hard_guides.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/pipeline/size_plan.h"
#include "hybrid_quad/pipeline/stage_clock.h"
#include "hybrid_quad/pipeline/wishes.h"

namespace hybrid_quad {

/// One connected component on its way through the stages, and what is to be said about it.
struct ComponentResult {
  QuadMesh mesh;              ///< anchors of corners are vertices of the plan's mesh
  FeatureGraph features;      ///< of the plan's mesh, whose curves the feature edges of `mesh` are on
  std::vector<PlaneSet> curve_planes;  ///< #curves: mirror planes in which each lies
  std::vector<GuideEdge> rings, chains;  ///< edges that hard guides cross, and that follow them
  int working_faces = 0;
  int field_singularities = 0, feature_singularities = 0;
  FieldChoice field_choice;
  int dislocations_found = 0, dislocations = 0;
  double area = 0, singular_area = 0, combinatorial_area = 0;
  PatchRecord patches;
  RepairRecord repairs;
  int flawed_quads = 0;  ///< quads that point against the surface or have no area
  int doubtful_quads = 0;  ///< these and smaller ones that only just pass that test
  std::vector<LengthLimit> limits;  ///< shorter edges for each doubtful quad
  std::vector<Vector3> flawed_places;  ///< middles of flawed quads
  int features_given_way = 0;  ///< feature curves by angle that gave way to the number of quads, to others or to valid quads
  int marks_given_way = 0;  ///< curves of marked edges and of guides that gave way to valid quads
  int missed_counts = 0;  ///< quad edges too many or too few on curves that were to get a certain number
  double extracted_quads = 0;  ///< in all tries of the pass
  double work = 0;       ///< of a WorkBudget, of these tries
  bool gave_up = false;  ///< quads are flawed, and there was no work left for another pass
  int passes = 0;        ///< whole passes with other settings until none was flawed
  std::vector<std::string> warnings;
};

/// What all passes beyond the components' first may take, in faces of working surfaces, counted for each try at an extraction.
/// A time would make the result depend on the machine.
struct WorkBudget {
  double left = 0;
  double for_marks = 0;  ///< of passes in which marked edges give way, when all others have been made
};

/// Remeshes one connected component (paper 3 and 4, then improvement).
/// \param wanted  number of quads to come near in the end, whatever the plan's lengths make
/// \param whole  the surface that the component is part of
/// \param budget  what passes beyond the first take is taken from it, at most half of what is left
ComponentResult remesh_component(const ComponentPlan& plan, double wanted, const SurfaceIndex& whole, const Wishes& wishes,
                                 const HardGuides& guides, const RemeshOptions& options, WorkBudget& budget, StageClock& clock,
                                 const RunContext& context);

/// What a component's field says before anything is improved.
struct ComponentPreview {
  WorkingSurface surface;
  FrameField frames;      ///< in quads: as they are extracted, or as they were asked for
  ComponentResult quads;  ///< one try, not improved; no quads where they were not asked for
};

/// The first steps of remesh_component: to the field, or to the quads of one try.
/// \param whole  the surface that the component is part of; null: no quads
ComponentPreview preview_component(const ComponentPlan& plan, double wanted, const SurfaceIndex* whole, const Wishes& wishes,
                                   const HardGuides& guides, const RemeshOptions& options,
                                   StageClock& clock, const RunContext& context);

}  // namespace hybrid_quad
