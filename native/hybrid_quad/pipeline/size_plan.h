#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "hybrid_quad/features/curve_counts.h"
#include "hybrid_quad/features/features.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/pipeline/hard_guides.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/pipeline/wishes.h"
#include "hybrid_quad/sizing/feature_size.h"
#include "hybrid_quad/sizing/thin_stretch.h"

namespace hybrid_quad {

/// A connected component, its feature curves, and how long its quads' edges are to be.
struct ComponentPlan {
  TriangleMesh mesh;            ///< the component with long edges halved: the same surface, old vertices first
  std::shared_ptr<const SurfaceIndex> index;  ///< of that mesh, with the features' regions
  FeatureGraph features;
  std::vector<PlaneSet> curve_planes;  ///< #curves: mirror planes in which each lies
  std::vector<PlannedChain> chains;    ///< as given: what their curves are to get
  std::vector<int> guides;      ///< 3 #F: the set of hard guides on the edge, -1: none; empty: no guides at all
  double length = 0;            ///< asked edge length at density 1, where nothing limits it (scene units)
  std::vector<double> unlimited;  ///< #V: asked edge length where nothing limits it
  std::vector<double> target;   ///< #V: asked edge length
  std::vector<double> needed;   ///< #V: the same before anything gave way for the number of quads
  double quads = 0;             ///< that fit
  std::vector<char> is_given;   ///< 3 #F: features whatever the number of quads
  std::vector<int> corners;     ///< vertices that are corners where a feature passes
  std::vector<CountedChain> asked_chains;  ///< edges of that mesh that are to get certain numbers of quads
  std::vector<double> density;  ///< #V asked lengths are shorter by, or empty: 1
  double least_ratio = 0, thin_ratio = 0;  ///< see FeatureSizeOptions
  std::optional<std::vector<ThinPlace>> thin_places;  ///< once they have been looked for
  ThinStretch thin_stretch;     ///< of quads on thin parts
  int part = -1;                ///< which of a run's components this is the plan for, scaled at most; -1: changed since
  double sharp_angle = 0;       ///< degrees above which edges by angle were looked at; 0: none were
  bool is_scarce = false;       ///< half as many quads as its topology calls for would have the asked length: so small, or with so many handles
  bool was_crowded = false;     ///< features by angle gave way to the number of quads
  std::shared_ptr<const ComponentPlan>
      with_all;  ///< the plan before they did, where quads that follow them all are not beyond reach; null: else
  int given_way = 0;            ///< feature curves by angle that gave way to the number of quads or to others
  int marks_given_way = 0;  ///< curves of marked edges and of guides that gave way to valid quads
};

/// Edges that are features whatever their angle.
struct MarkedEdges {
  std::vector<std::array<int, 2>> ends;  ///< vertices
  std::vector<int> guides;               ///< of each: the set of hard guides on it, -1: none
};

/// \param length  edge length asked for; a component too small for it gets a shorter one
/// \param marked  edges that are features
/// \param chains  edges of the component that are to get certain numbers of quads
ComponentPlan plan_component(const TriangleMesh& mesh, double length, const MarkedEdges& marked,
                             const std::vector<CountedChain>& chains, const Wishes& wishes,
                             const RemeshOptions& options, const RunContext& context);

/// Small features and thin parts need shorter edges than was asked: lengthens the others, in all components alike and by
/// no more than three fifths, until as many quads fit as were asked for; where that is not enough, then lengthens the short
/// ones too, by no more than twice.
void balance_plans(std::vector<ComponentPlan>& plans, double quads_asked, const RunContext& context);

/// Where features by angle leave no room for quads as large as the number asks for, because there are nearly as many curves
/// as quads, those give way that crowd the most; lengths are planned and balanced anew.
/// \returns whether any did
bool make_room_for_count(std::vector<ComponentPlan>& plans, double quads_asked, PlaneSet mirror_planes, const RunContext& context);

/// The plan for as many quads with more vertices as corners, where a feature passes.
ComponentPlan with_corners(const ComponentPlan& plan, const std::vector<int>& corners, PlaneSet mirror_planes, const RunContext& context);

/// The plan with edges as short as four quads around thin tubes and tips need, or nearly (docs/decisions/0052). Where they already are, or
/// nothing shorter is within bounds, the same plan.
/// \param most_growth  times as many quads as without thin parts may be needed
/// \param is_by_count  for as many quads as before: other edges get longer
ComponentPlan with_room_for_thin_parts(const ComponentPlan& plan, double most_growth, bool is_by_count,
                                       const RunContext& context);

/// The plan with four quads around thin tubes and tips that are longer along these than around (docs/decisions/0053), and others as long as
/// that needs. For as many quads as before where that can be; where not, and nearly all is tubes, for up to four times as many.
/// \param tubes  of the plan  \param most_growth  times as many quads as planned may be needed before others are made longer for it
/// \returns none where even that is not enough
std::optional<ComponentPlan> with_long_quads(const ComponentPlan& plan, const ThinTubes& tubes, double most_growth,
                                             bool is_by_count, const RunContext& context);

/// The plan for as many quads with fewer features by angle, where these are cramped: more than a few are shorter than quads, or some
/// gave way to the number already. Else the same plan.
ComponentPlan with_room_for_shapes(const ComponentPlan& plan, PlaneSet mirror_planes, const RunContext& context);

/// The plan for as many quads without any features by angle.
ComponentPlan without_features_by_angle(const ComponentPlan& plan, PlaneSet mirror_planes, const RunContext& context);

/// The plan for as many quads without the features by angle that pass within an edge of some places.
ComponentPlan without_features_at(const ComponentPlan& plan, const std::vector<Vector3>& places, PlaneSet mirror_planes, const RunContext& context);

/// The plan for as many quads without any features, marked ones neither, that pass near some places; but with the boundary and curves
/// that have an asked count. \param reach  how near, in the edges that features there need
ComponentPlan without_marks_at(const ComponentPlan& plan, const std::vector<Vector3>& places, double reach,
                               PlaneSet mirror_planes, const RunContext& context);

/// The plan for no more quads without hard guides and asked counts along curves, if there are any.
std::optional<ComponentPlan> without_exact_wishes(const ComponentPlan& plan, const HardGuides& guides, PlaneSet mirror_planes,
                                                  const RunContext& context);

/// The same lengths for more or fewer quads.
void scale_plan(ComponentPlan& plan, double quads_factor);

/// The plan for a number of quads that is larger by a factor, with shorter edges at some places.
/// \param as_needed  nothing gives way for the number of quads, which is what it takes
ComponentPlan refined_plan(const ComponentPlan& plan, double quads_factor, bool as_needed,
                           const std::vector<LengthLimit>& limits, const RunContext& context);

}  // namespace hybrid_quad
