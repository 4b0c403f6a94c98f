#pragma once

#include <vector>

#include "hybrid_quad/improve/quad_moves.h"
#include "hybrid_quad/improve/sequence_memory.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// How far a search goes.
struct SearchLimits {
  int depth;
  double slack;      ///< how much worse than the start a beginning of a sequence may be
  double least_gain;
  int trials;
  int beam;
  std::size_t kept;  ///< sequences to return
};

/// Best-first search for short sequences of moves around a vertex that lower the valence cost.
class SequenceSearch {
 public:
  /// \param effort  moves to try in all runs together, per quad of the mesh: a mesh that is bad everywhere must not cost
  ///                more than a good one by orders of magnitude
  /// \param memory  of the same mesh and limits, or null
  SequenceSearch(EditMesh& mesh, int effort, SequenceMemory* memory = nullptr)
      : mesh_(mesh), memory_(memory), effort_left_(kLeastEffort + static_cast<long long>(effort) * mesh.quad_count()) {}

  bool exhausted() const { return effort_left_ <= 0; }
  /// Counts one change on trial, relaxed and perhaps undone, as so many moves tried.
  void count_trial() { effort_left_ -= kEffortOfTrial; }

  /// The best sequences that begin at a quad around `seeds`, best first; the mesh is as before.
  const std::vector<Sequence>& run(const std::vector<int>& seeds, const SearchLimits& limits);
  /// The same around one vertex, from memory where nothing has changed.
  const std::vector<Sequence>& run_around(int v, const SearchLimits& limits);

 private:
  static constexpr int kLeastEffort = 20000, kEffortOfTrial = 100;

  void extend(const std::vector<int>& seeds, const Sequence& so_far);
  std::vector<Move> moves_around(const std::vector<int>& seeds) const;
  void remember(const Sequence& sequence);

  EditMesh& mesh_;
  SequenceMemory* memory_;
  long long effort_left_;
  SearchLimits limits_{};
  int trials_left_ = 0;
  std::vector<Sequence> best_;
};

/// Makes the moves; a free vertex that others collapse into goes to the middle.
void make_sequence(Workpiece& piece, const Sequence& sequence);

/// All vertices of the quads that a sequence replaces.
std::vector<int> touched_by(Workpiece& piece, const Sequence& sequence);

}  // namespace hybrid_quad
