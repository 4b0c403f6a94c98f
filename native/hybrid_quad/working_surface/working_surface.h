#pragma once

#include <vector>

#include "hybrid_quad/features/features.h"
#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// The surface that the field and the parameterization are solved on: the input, remeshed to well-shaped triangles at
/// a fraction of the quad size, so that cost follows the output and slivers or huge faces of the input do no harm.
struct WorkingSurface {
  TriangleMesh mesh;
  FeatureGraph features;            ///< the same curves (same ids, same direction) and regions (same ids) as the input's
  std::vector<int> input_vertex;    ///< #V: the input vertex it is, or -1 for a vertex made here; corners always have one
  std::vector<int> near_face;  ///< #V: an input face about the vertex, on its sheet however near others are
  std::vector<double> target_length;  ///< #F: asked quad edge length h at the face (scene units)
};

struct WorkingSurfaceOptions {
  double edge_fraction = 0.84;        ///< aimed edge length over h
  double feature_edge_limit = 0.5;     ///< eps_b of paper 3.2: no feature edge longer than this, over h
};

/// Splits, half-edge collapses and flips (no vertex leaves the input surface's vicinity; features stay on their curves),
/// topology kept by the link condition. No inner edge joins two feature vertices afterwards (paper 3.2).
/// \param target_length  #V of the input: h at each vertex (scene units, > 0)
/// \post  same topology, same feature curves, no face without area
/// \param index  of the input, with the features' regions
WorkingSurface build_working_surface(const SurfaceIndex& index, const FeatureGraph& features,
                                     const std::vector<double>& target_length, const WorkingSurfaceOptions& options,
                                     const RunContext& context);
WorkingSurface build_working_surface(const TriangleMesh& input, const FeatureGraph& features,
                                     const std::vector<double>& target_length, const WorkingSurfaceOptions& options,
                                     const RunContext& context);

std::vector<std::string> violations_of(const WorkingSurface& surface, const TriangleMesh& input, const FeatureGraph& features);

}  // namespace hybrid_quad
