#pragma once

#include <cstdint>
#include <vector>

#include "hybrid_quad/improve/quad_moves.h"

namespace hybrid_quad {

/// What searches for sequences around single vertices found. The same is found again as long as the quads are the same that a
/// search can look at, whatever has become of the others and wherever vertices have moved.
class SequenceMemory {
 public:
  struct Found {
    int trials = 0;  ///< that the search took
    std::vector<Sequence> best;
  };

  /// What was found around v with the quads as they are; null where nothing is known. \param depth  most moves of a sequence
  const Found* recall(const EditMesh& mesh, int v, int depth);
  /// \pre `recall` of the same vertex came last, and gave null
  const Found& remember(int v, Found found);

 private:
  struct Known {
    std::uint64_t quads = 0;
    Found found;
  };

  std::uint64_t quads_around(const EditMesh& mesh, int v, int depth);

  std::vector<Known> known_;     // by vertex
  std::vector<int> seen_;        // by vertex: in which turn
  std::vector<int> ring_, next_;
  int turn_ = 0;
};

}  // namespace hybrid_quad
