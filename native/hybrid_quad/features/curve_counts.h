#pragma once

#include <array>
#include <string>
#include <vector>

#include "hybrid_quad/features/features.h"

namespace hybrid_quad {

/// A chain of edges, all of them features, that is to get a certain number of quad edges: a path or a loop.
struct CountedChain {
  std::vector<std::array<int, 2>> edges;  ///< pairs of vertices, in any order
  int count = 0;
};

/// Why a chain is to get another number than was asked for.
enum class CountObstacle { kNone, kParity, kTooFew };

struct PlannedChain {
  std::vector<int> curves;  ///< that it consists of
  int count = 0;            ///< that they are to get together
  CountObstacle obstacle = CountObstacle::kNone;
};

/// The vertices at which a chain ends: as corners they make it consist of whole curves.
std::vector<int> chain_ends(const CountedChain& chain);

/// Writes asked_count of the curves that the chains consist of: the chain's number, dealt out by length where corners lie
/// on it, with the nearest number that a mesh of quads can have where it cannot have this one. Every curve gets at least
/// one edge and every loop four; loops, of one curve or of several that all have a count, need an even number.
/// \pre the ends of the chains are corners, and no edge is in two chains
std::vector<PlannedChain> plan_curve_counts(const TriangleMesh& mesh, const std::vector<CountedChain>& chains,
                                            FeatureGraph& features);

}  // namespace hybrid_quad
