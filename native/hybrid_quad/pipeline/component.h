#pragma once

#include "hybrid_quad/features/features.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/pipeline/stage_clock.h"

namespace hybrid_quad {

/// One connected component on its way through the stages, and what is to be said about it.
struct ComponentResult {
  QuadMesh mesh;              ///< anchors of corners are vertices of the component
  FeatureGraph features;      ///< of the component's input
  int working_faces = 0;
  int field_singularities = 0;
  int dislocations_found = 0, dislocations = 0;
  double area = 0, singular_area = 0, combinatorial_area = 0;
  PatchRecord patches;
  int flawed_quads = 0;  ///< quads that point against the surface or have no area
  int doubtful_quads = 0;  ///< these and smaller ones that only just pass that test
  int passes = 0;        ///< whole passes with other settings until none was flawed
  std::vector<std::string> warnings;
};

/// Remeshes one connected component (paper 3 and 4, then improvement).
/// \param quads_asked  for this component
/// \param usual_length  quad edge length of the whole mesh (scene units)
/// \param marked  pairs of the component's vertices that are features
ComponentResult remesh_component(const TriangleMesh& mesh, double quads_asked, double usual_length,
                                 const std::vector<std::array<int, 2>>& marked, const RemeshOptions& options,
                                 StageClock& clock, const RunContext& context);

}  // namespace hybrid_quad
