#pragma once

#include <array>
#include <string>
#include <vector>

#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {

/// What the first stages of a run say about its result, in the caller's units and on the whole surface, mirror images included.
struct Preview {
  /// One of each face of the working surface: its middle, its unit normal, and the two edge vectors of a quad there
  /// (without quads, as large as it was asked for).
  std::vector<Vector3> points, normals, u, v;
  std::vector<int> spread;  ///< of these, ones about as far from each other as a quad is long: enough to draw
  std::vector<Vector3> singular_points;
  std::vector<int> singular_quarters;  ///< +1: three quads meet there, -1: five do
  std::vector<std::array<Vector3, 2>> feature_lines;  ///< edges of the working surface on features and boundaries
  QuadMesh quads;       ///< of one try, not improved: empty where they were not asked for
  double wanted = 0;    ///< number of quads that the run would aim at
  std::vector<Defect> defects;  ///< of the input, repaired on the way
  std::vector<std::string> warnings;
  std::vector<StageRecord> stages;
};

/// The first stages of remesh(): repair, features, sizes, field, and, with quads, the extraction of a single try.
/// \throws InputError, Cancelled, InternalError as remesh()
Preview preview(const PolygonSoup& soup, const RemeshOptions& options, bool with_quads, const RunContext& context);

}  // namespace hybrid_quad
