#pragma once

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/pipeline/hard_guides.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/pipeline/size_plan.h"

namespace hybrid_quad {

/// An improved mesh, in which guides are chains of edges so far.
struct GuidedQuads {
  QuadMesh mesh;
  FeatureGraph features;        ///< whose curves the feature edges are on
  std::vector<GuideEdge> rings;   ///< edges that ring guides cross
  std::vector<GuideEdge> chains;  ///< edges that follow guides
  int flawed = 0;
};

/// Replaces chains on ring guides by strips, one guide after the other, and smooths so that the guides cross edges in the
/// middle; a strip that cannot be had, or that would bring flawed quads, is left out: its guide stays a chain of edges.
/// Puts the other chains on both sides of their guides.
/// \param improve  how the mesh was improved
void settle_guides(GuidedQuads& guided, const ComponentPlan& plan, const HardGuides& guides, ImproveOptions improve,
                   const RemeshOptions& options, const SurfaceIndex& whole, const RunContext& context);

}  // namespace hybrid_quad
