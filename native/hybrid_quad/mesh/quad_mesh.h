#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

enum class VertexKind : std::uint8_t { kFree, kCurve, kCorner };

/// The result: an indexed pure-quad mesh, each vertex bound to where it may move on the *input* surface.
struct QuadMesh {
  std::vector<Vector3> positions;
  std::vector<std::array<int, 4>> quads;
  std::vector<VertexKind> kind;  ///< #V
  std::vector<int>
      anchor;  ///< #V: kFree: region (FeatureGraph::face_region); kCurve: curve id; kCorner: input vertex id (-1: a mirror plane made it)
  std::vector<int> near_face;  ///< #V: an input face about the vertex, on its sheet however near others are; -1 not known
  struct FeatureEdge {
    int a, b, curve;  ///< vertices in the direction of the curve
  };
  std::vector<FeatureEdge> feature_edges;  ///< chains that cover the feature curves, boundary included
};

/// Of the sides of all quads (an inner edge counts twice); 0 without quads.
double mean_edge_length(const QuadMesh& mesh);

/// The mean of a quad's corners.
Vector3 middle_of(const QuadMesh& mesh, int q);

/// Everything the result must satisfy as an indexed polygon mesh, checked by code that shares nothing with
/// what built it: four distinct vertices a face, edges in one or two faces with opposite direction, one fan a
/// vertex, no interior vertex with fewer than three faces, no two faces with two common edges, finite
/// coordinates.
std::vector<std::string> violations_of(const QuadMesh& mesh);

/// Quads whose area vector is nothing beside a square of the mean edge length, ascending.
std::vector<int> quads_without_area(const QuadMesh& mesh);

/// What a result may not have: no quads, what violations_of finds, quads without area.
std::vector<std::string> violations_of_result(const QuadMesh& mesh);

}  // namespace hybrid_quad
