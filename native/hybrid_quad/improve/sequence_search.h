#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/improve/quad_moves.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Moves to be made one after the other.
struct Sequence {
  double cost = 0;  ///< change of the valence cost, and a little for every move
  int length = 0;
  std::array<Move, 3> moves{};
};

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
  SequenceSearch(EditMesh& mesh, int effort)
      : mesh_(mesh), effort_left_(kLeastEffort + static_cast<long long>(effort) * mesh.quad_count()) {}

  bool exhausted() const { return effort_left_ <= 0; }
  /// Counts one change on trial, relaxed and perhaps undone, as so many moves tried.
  void count_trial() { effort_left_ -= kEffortOfTrial; }

  /// The best sequences that begin at a quad around `seeds`, best first; the mesh is as before.
  const std::vector<Sequence>& run(const std::vector<int>& seeds, const SearchLimits& limits);

 private:
  static constexpr int kLeastEffort = 20000, kEffortOfTrial = 100;

  void extend(const std::vector<int>& seeds, const Sequence& so_far);
  std::vector<Move> moves_around(const std::vector<int>& seeds) const;
  void remember(const Sequence& sequence);

  EditMesh& mesh_;
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
