#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/mesh_builder.h"

namespace hybrid_quad {

struct SubdivisionOptions {
  int levels = 2;     ///< each makes four faces of a quad; 1 or more
  bool limit = true;  ///< vertices move on to where endless subdivision would put them
  bool keep_corners = false;  ///< boundary vertices of one face stay where they are
  std::vector<std::array<int, 2>> crease_edges;
  std::vector<double> crease_sharpness;  ///< of each; 10 and more: infinitely sharp
  std::vector<int> sharp_vertices;
  std::vector<double> vertex_sharpness;  ///< of each, likewise
};

struct SubdividedMesh {
  std::vector<Vector3> positions;
  std::vector<Vector3> normals;  ///< #V unit normals of the limit surface; empty without `limit`
  std::vector<std::array<int, 4>> quads;
  std::vector<int> face;         ///< #quads: the given face that each is part of
};

/// Subdivides by Catmull and Clark's rules (OpenSubdiv).
/// \throws InputError malformed_faces, index_out_of_range or unknown_edge (names elements); InternalError if OpenSubdiv refuses
SubdividedMesh subdivide(const PolygonSoup& mesh, const SubdivisionOptions& options, const RunContext& context);

}  // namespace hybrid_quad
