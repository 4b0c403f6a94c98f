#include "hybrid_quad/improve/valence_moves.h"

#include "hybrid_quad/improve/sequence_search.h"
#include "hybrid_quad/improve/trial.h"

namespace hybrid_quad {

namespace {

/// Tries the best sequences around v until one stays. \returns its length, 0 if none does
int improve_around(Workpiece& piece, Smoother& smoother, SequenceSearch& search, int v, const SearchLimits& limits) {
  constexpr double kGoodEnough = 0.7;
  const std::vector<Sequence> sequences = search.run_around(v, limits);
  for (const Sequence& sequence : sequences) {
    search.count_trial();
    Trial trial(piece, smoother, touched_by(piece, sequence));
    make_sequence(piece, sequence);
    if (trial.keep(kGoodEnough, 0)) return sequence.length;
  }
  return 0;
}

}  // namespace

int straighten_features(Workpiece& piece, Smoother& smoother, SequenceMemory& memory, const RunContext& context) {
  constexpr SearchLimits kLimits{3, 30, 2.0, 6000, 6, 3};
  SequenceSearch search(piece.mesh, 40, &memory);
  int moves = 0;
  const int n = piece.mesh.vertex_count();
  for (int v = 0; v < n && !search.exhausted(); ++v) {
    if ((v & 255) == 0) context.checkpoint();
    if (has_straight_corner(piece.mesh, v)) moves += improve_around(piece, smoother, search, v, kLimits);
  }
  return moves;
}

int improve_valences(Workpiece& piece, Smoother& smoother, SequenceMemory& memory, const RunContext& context) {
  constexpr SearchLimits kLimits{2, 3, 0.9, 400, 5, 3};
  constexpr int kPasses = 2;
  SequenceSearch search(piece.mesh, 80, &memory);
  int moves = 0;
  const int n = piece.mesh.vertex_count();
  for (int pass = 0; pass < kPasses; ++pass) {
    int made = 0;
    for (int v = 0; v < n && !search.exhausted(); ++v) {
      if ((v & 255) == 0) context.checkpoint();
      if (valence_cost(piece.mesh, v) > 0.5) made += improve_around(piece, smoother, search, v, kLimits);
    }
    moves += made;
    if (made == 0) break;
  }
  return moves;
}

int improve_shapes(Workpiece& piece, Smoother& smoother, const RunContext& context) {
  constexpr double kBad = 0.4, kGain = 0.1;
  constexpr SearchLimits kLimits{2, 8, -4.5, 800, 8, 16};
  SequenceSearch search(piece.mesh, 40);
  int moves = 0;
  for (int q = 0; q < piece.mesh.quad_count() && !search.exhausted(); ++q) {
    if (!piece.mesh.alive(q) || smoother.signed_quality(q) >= kBad) continue;
    context.checkpoint();
    const EditMesh::Quad corners = piece.mesh.quad(q);
    const std::vector<Sequence> sequences = search.run({corners.begin(), corners.end()}, kLimits);
    for (const Sequence& sequence : sequences) {
      search.count_trial();
      Trial trial(piece, smoother, touched_by(piece, sequence));
      make_sequence(piece, sequence);
      if (!trial.keep(kBad + kGain, kGain)) continue;
      moves += sequence.length;
      break;
    }
  }
  return moves;
}

}  // namespace hybrid_quad
