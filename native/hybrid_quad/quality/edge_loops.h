#pragma once

#include <vector>

#include "hybrid_quad/mesh/quad_complex.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

/// The edges of a quad mesh as chains that go straight on at every vertex of four quads (of two along the boundary), to an
/// irregular vertex, a corner, or the boundary; or around, to where they began. Every edge is in one chain.
///
/// A chain *crosses itself* where it passes a vertex twice. It *spirals* where it passes beside itself in the same
/// direction, as a thread does on a screw: some edge of it is reached from another by going straight across at most three
/// quads, and less far than along the chain.
struct EdgeLoops {
  struct Chain {
    int length = 0;  ///< edges
    bool is_closed = false, crosses_itself = false, spirals = false;
  };
  std::vector<Chain> chains;
  std::vector<int> of_dart;  ///< 4 #Q: the chain of a side
};
EdgeLoops trace_edge_loops(const QuadComplex& complex);

EdgeLoopSummary summary_of(const EdgeLoops& loops);

}  // namespace hybrid_quad
