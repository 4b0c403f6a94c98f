#pragma once

#include <array>
#include <string>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Triangles with their gluing: always a union of oriented 2-manifolds.
struct ManifoldGluing {
  std::vector<Vector3> positions;
  std::vector<std::array<int, 3>> faces;
  std::vector<int> opposite;          ///< 3 #F
  std::vector<int> source_vertex;     ///< #V: vertex of the input it is a copy of
  std::vector<char> was_flipped;      ///< #F
  std::vector<std::array<int, 2>> non_manifold_edges;
  int torn_sides = 0;                 ///< of faces, left alone at non-manifold edges
  std::vector<int> non_manifold_vertices;
  std::vector<std::array<int, 2>> twisted_edges;  ///< cut: with them, a component would have one side only
  std::vector<int> non_orientable_faces;  ///< not empty: the faces of a component without a consistent orientation
};

/// Glues triangles along their common edges. Where more than two faces meet, the flattest pairs stay together and the
/// others part, or all where more than 64 do; a vertex with several fans becomes several vertices. Each component is oriented as most of its faces
/// are; one that was inconsistent and is closed is oriented outwards.
/// A component with one side only is cut along the edges across which its faces, as they were given, turn over, where these are short in all: .15
/// times the root of its area at most. A Moebius strip or Klein bottle has longer ones, and is not glued.
/// \throws Cancelled
ManifoldGluing glue_triangles(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& faces,
                              const RunContext& context = {});

}  // namespace hybrid_quad
