#pragma once

#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/pipeline/hard_guides.h"
#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {

/// The input with its hard guides as marked edges.
struct GuidedInput {
  BuiltMesh built;        ///< what input_vertex says beyond the polygon soup's vertices are new ones
  RemeshOptions options;  ///< guides are marked edges; values at vertices are those of the new vertices too
  HardGuides guides;      ///< of options.strokes
  std::vector<int> edge_guides;  ///< 3 #F of built.mesh: the set of guides on the edge, -1: none
  std::vector<std::string> warnings;
};

/// Inserts options.strokes. Values at the new vertices lie between those of the triangle's corners; directions, which have
/// no middle, are those of the nearest.
/// \param soup_vertices  how many the polygon soup has
GuidedInput with_guides(BuiltMesh built, int soup_vertices, const RemeshOptions& options, const RunContext& context);

/// The parts of traces where the coordinates of all planes are positive.
std::vector<StrokeTrace> positive_traces(const std::vector<StrokeTrace>& traces, PlaneSet planes);

/// Edges of the whole result that guides cross, and that follow them.
struct GuidedEdges {
  std::vector<GuideEdge> rings, chains;
};

/// What became of each guide, with warnings about those that are not met.
std::vector<GuideRecord> measure_guides(const std::vector<GuideStroke>& strokes, const std::vector<StrokeTrace>& traces,
                                        const QuadMesh& quads, const GuidedEdges& guided,
                                        std::vector<std::string>& warnings);

}  // namespace hybrid_quad
