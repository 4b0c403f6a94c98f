#include "hybrid_quad/improve/sequence_search.h"

#include <algorithm>

namespace hybrid_quad {

namespace {

constexpr double kWorthIt = 1e-9;

}  // namespace

const std::vector<Sequence>& SequenceSearch::run(const std::vector<int>& seeds, const SearchLimits& limits) {
  limits_ = limits;
  trials_left_ = limits.trials;
  best_.clear();
  extend(seeds, Sequence{});
  effort_left_ -= limits.trials - std::max(0, trials_left_);
  return best_;
}

const std::vector<Sequence>& SequenceSearch::run_around(int v, const SearchLimits& limits) {
  if (!memory_) return run({v}, limits);
  if (const SequenceMemory::Found* found = memory_->recall(mesh_, v, limits.depth)) {
    effort_left_ -= found->trials;  // as if it had been searched for: memory must not change what is found later
    return found->best;
  }
  const long long effort_before = effort_left_;
  run({v}, limits);
  return memory_->remember(v, {static_cast<int>(effort_before - effort_left_), best_}).best;
}

void SequenceSearch::extend(const std::vector<int>& seeds, const Sequence& so_far) {
  struct Candidate {
    Sequence sequence;
    Changed changed;
  };
  std::vector<Candidate> candidates;
  for (const Move& move : moves_around(seeds)) {
    if (--trials_left_ < 0) break;
    Changed changed;
    if (!may_move(mesh_, move, &changed)) continue;
    Sequence longer = so_far;
    longer.cost += cost_of_move(mesh_, move, changed) + (move.kind == Move::kCollapse ? 0.02 : 0.01);
    longer.moves[longer.length++] = move;
    remember(longer);
    if (longer.length < limits_.depth && longer.cost < limits_.slack) candidates.push_back({longer, changed});
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
    return x.sequence.cost < y.sequence.cost;
  });
  if (static_cast<int>(candidates.size()) > limits_.beam) candidates.resize(limits_.beam);
  for (const Candidate& candidate : candidates) {
    const std::size_t mark = mesh_.mark();
    make_move(mesh_, candidate.sequence.moves[candidate.sequence.length - 1]);
    std::vector<int> costly;
    for (const int v : candidate.changed.vertex)
      if (v >= 0 && mesh_.valence(v) > 0 && valence_cost(mesh_, v) > 0.5) costly.push_back(v);
    if (!costly.empty()) extend(costly, candidate.sequence);
    mesh_.undo_to(mark);
  }
}

std::vector<Move> SequenceSearch::moves_around(const std::vector<int>& seeds) const {
  std::vector<int> quads;
  for (const int v : seeds) quads.insert(quads.end(), mesh_.quads_at(v).begin(), mesh_.quads_at(v).end());
  std::sort(quads.begin(), quads.end());
  quads.erase(std::unique(quads.begin(), quads.end()), quads.end());
  std::vector<Move> moves;
  for (const int q : quads) {
    for (int i = 0; i < 2; ++i) moves.push_back({Move::kCollapse, q, i});
    for (int i = 0; i < 4; ++i) {
      moves.push_back({Move::kRotateBack, q, i});
      moves.push_back({Move::kRotateForth, q, i});
    }
  }
  return moves;
}

void SequenceSearch::remember(const Sequence& sequence) {
  if (sequence.cost > -limits_.least_gain) return;
  const auto place = std::find_if(best_.begin(), best_.end(),
                                  [&](const Sequence& other) { return sequence.cost < other.cost - kWorthIt; });
  best_.insert(place, sequence);
  if (best_.size() > limits_.kept) best_.pop_back();
}

void make_sequence(Workpiece& piece, const Sequence& sequence) {
  for (int i = 0; i < sequence.length; ++i) {
    const Move& move = sequence.moves[i];
    int kept, gone;
    if (move.collapses() && collapse_ends(piece.mesh, move, &kept, &gone) &&
        piece.mesh.is_free(kept) && !piece.mesh.is_pinned(kept) && piece.face[kept] >= 0) {
      const Vector3 middle = 0.5 * (piece.mesh.positions[kept] + piece.mesh.positions[gone]);
      const SurfacePoint point = piece.walk(middle, piece.face[kept]);
      if (point.face >= 0) {
        piece.face[kept] = point.face;
        piece.mesh.positions[kept] = point.position;
      }
    }
    make_move(piece.mesh, move);
  }
}

std::vector<int> touched_by(Workpiece& piece, const Sequence& sequence) {
  const std::size_t mark = piece.mesh.mark();
  std::vector<int> vertices;
  const auto add_around = [&](const Move& move) {
    int kept, gone;
    Hexagon hexagon;
    std::vector<int> quads;
    if (move.collapses() && collapse_ends(piece.mesh, move, &kept, &gone))
      quads = piece.mesh.quads_at(gone);
    else if (!move.collapses() && hexagon_of(piece.mesh, move, &hexagon))
      quads = {move.quad, hexagon.other};
    for (const int v : merged_away(piece.mesh, move)) quads.insert(quads.end(), piece.mesh.quads_at(v).begin(), piece.mesh.quads_at(v).end());
    for (const int q : quads) vertices.insert(vertices.end(), piece.mesh.quad(q).begin(), piece.mesh.quad(q).end());
  };
  for (int i = 0; i < sequence.length; ++i) {
    add_around(sequence.moves[i]);
    make_move(piece.mesh, sequence.moves[i]);
  }
  piece.mesh.undo_to(mark);
  return vertices;
}

}  // namespace hybrid_quad
