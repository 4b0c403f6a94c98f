#pragma once

#include <memory>
#include <vector>

#include "hybrid_quad/mesh/unit_frame.h"
#include "hybrid_quad/pipeline/curve_counts.h"
#include "hybrid_quad/pipeline/guided_input.h"
#include "hybrid_quad/pipeline/size_plan.h"
#include "hybrid_quad/pipeline/stage_clock.h"
#include "hybrid_quad/pipeline/symmetric_domain.h"
#include "hybrid_quad/pipeline/wishes.h"

namespace hybrid_quad {

/// A connected part of what is remeshed.
struct Component {
  TriangleMesh mesh;
  std::vector<int> vertex;  ///< #V: vertex of the whole mesh
  std::vector<int> face;    ///< #F: face of the whole mesh
};

/// What a run goes by, before any field: the repaired surface in a frame of its own, the part of it that is remeshed, its
/// components, and where their features and how long their edges are to be.
struct RunPlan {
  RemeshOptions options;  ///< in the frame
  RunContext context;     ///< whose snapshots come in the caller's units
  UnitFrame frame;
  GuidedInput input;
  RemeshDomain domain;
  HardGuides guides;
  int images = 1;         ///< mirror images that make up the whole
  std::vector<Component> components;
  std::vector<MarkedEdges> marked;  ///< of each component, as the next two
  std::vector<Wishes> wishes;
  std::vector<ComponentPlan> plans;
  CurveCountLedger counts;
  double area = 0;          ///< of the remeshed part
  double wanted = 0;        ///< quads, of the whole
};

/// \param report  gets what there is to say of the input
/// \throws InputError, Cancelled, InternalError as remesh()
RunPlan plan_run(const PolygonSoup& soup, const RemeshOptions& scene_options, const RunContext& scene_context,
                 RemeshReport& report, StageClock& clock);

/// The surface that a plan is for.
inline const TriangleMesh& surface_of(const RunPlan& run) { return run.input.built.mesh; }
/// Of the surface that a plan is for, without regions; the one of its only component, where that is the same.
std::shared_ptr<const SurfaceIndex> index_of_whole(const RunPlan& run);
/// Of each component in the remeshed area, 1 in all.
std::vector<double> shares_of_area(const RunPlan& run);

}  // namespace hybrid_quad
