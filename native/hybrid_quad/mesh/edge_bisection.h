#pragma once

#include <array>
#include <limits>
#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

using EdgeSet = std::vector<std::array<int, 2>>;  ///< pairs of neighbouring vertices

struct BisectedMesh {
  TriangleMesh mesh;             ///< vertices keep their ids, new ones follow
  EdgeSet marked_edges;          ///< the parts of the marked edges and of the chains'
  std::vector<int> source;       ///< of each part: the marked edge it is of, one of those given; -1: only of a chain
  std::vector<EdgeSet> chains;   ///< the parts of each
  std::vector<int> face_source;  ///< #F: the face that each is a part of
};

/// The same surface with no edge longer than `longest` and no two with the same two ends: edges are halved, longest first (Rivara 1984), so that what is
/// known at vertices is known everywhere.
/// \param chains  sets of edges, no edge in two of them, that are marked too but told apart
/// \param most_splits  after so many halvings the edges that are left, none longer than any that was halved, stay as they are
BisectedMesh bisect_long_edges(const TriangleMesh& mesh, double longest, const EdgeSet& marked_edges,
                               const std::vector<EdgeSet>& chains = {},
                               double most_splits = std::numeric_limits<double>::infinity());

/// The least length from `longest` on at which halving falls into about `most_pieces` edges, of those that are longer: thin as a
/// hair, a surface would be cut into as many pieces as its length has widths.
double affordable_length(const TriangleMesh& mesh, double longest, double most_pieces);

}  // namespace hybrid_quad
