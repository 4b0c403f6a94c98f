#include "hybrid_quad/improve/valence_moves.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hybrid_quad {

namespace {

constexpr double kWorthIt = 1e-9;

struct Sequence {
  double cost = 0;  ///< change of the valence cost, and a little for every move
  int length = 0;
  std::array<Move, 3> moves{};
};

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
  SequenceSearch(EditMesh& mesh, int effort) : mesh_(mesh), effort_left_(kLeastEffort + static_cast<long long>(effort) * mesh.quad_count()) {}

  bool exhausted() const { return effort_left_ <= 0; }
  /// Counts one change on trial, relaxed and perhaps undone, as so many moves tried.
  void count_trial() { effort_left_ -= kEffortOfTrial; }

  /// The best sequences that begin at a quad around `seeds`, best first; the mesh is as before.
  const std::vector<Sequence>& run(const std::vector<int>& seeds, const SearchLimits& limits) {
    limits_ = limits;
    trials_left_ = limits.trials;
    best_.clear();
    extend(seeds, Sequence{});
    effort_left_ -= limits.trials - std::max(0, trials_left_);
    return best_;
  }

 private:
  static constexpr int kLeastEffort = 20000, kEffortOfTrial = 100;

  void extend(const std::vector<int>& seeds, const Sequence& so_far) {
    struct Candidate {
      Sequence sequence;
      Changed changed;
    };
    std::vector<Candidate> candidates;
    for (const Move& move : moves_around(seeds)) {
      if (--trials_left_ < 0) break;
      Changed changed;
      if (!may_move(mesh_, move, &changed)) continue;
      const double before = changed.cost(mesh_);
      const std::size_t mark = mesh_.mark();
      make_move(mesh_, move);
      const double after = changed.cost(mesh_);
      mesh_.undo_to(mark);
      Sequence longer = so_far;
      longer.cost += after - before + (move.kind == Move::kCollapse ? 0.02 : 0.01);
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
        if (mesh_.valence(v) > 0 && valence_cost(mesh_, v) > 0.5) costly.push_back(v);
      if (!costly.empty()) extend(costly, candidate.sequence);
      mesh_.undo_to(mark);
    }
  }

  std::vector<Move> moves_around(const std::vector<int>& seeds) const {
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

  void remember(const Sequence& sequence) {
    if (sequence.cost > -limits_.least_gain) return;
    const auto place = std::find_if(best_.begin(), best_.end(),
                                    [&](const Sequence& other) { return sequence.cost < other.cost - kWorthIt; });
    best_.insert(place, sequence);
    if (best_.size() > limits_.kept) best_.pop_back();
  }

  EditMesh& mesh_;
  long long effort_left_;
  SearchLimits limits_{};
  int trials_left_ = 0;
  std::vector<Sequence> best_;
};

void make_sequence(Workpiece& piece, const Sequence& sequence) {
  for (int i = 0; i < sequence.length; ++i) {
    const Move& move = sequence.moves[i];
    int kept, gone;
    if (move.kind == Move::kCollapse && collapse_ends(piece.mesh, move, &kept, &gone) &&
        piece.mesh.is_free(kept) && piece.face[kept] >= 0) {
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

/// All vertices of the quads that a sequence replaces.
std::vector<int> touched_by(Workpiece& piece, const Sequence& sequence) {
  const std::size_t mark = piece.mesh.mark();
  std::vector<int> vertices;
  const auto add_around = [&](const Move& move) {
    int kept, gone;
    Hexagon hexagon;
    std::vector<int> quads;
    if (move.kind == Move::kCollapse && collapse_ends(piece.mesh, move, &kept, &gone))
      quads = piece.mesh.quads_at(gone);
    else if (move.kind != Move::kCollapse && hexagon_of(piece.mesh, move, &hexagon))
      quads = {move.quad, hexagon.other};
    for (const int q : quads) vertices.insert(vertices.end(), piece.mesh.quad(q).begin(), piece.mesh.quad(q).end());
  };
  for (int i = 0; i < sequence.length; ++i) {
    add_around(sequence.moves[i]);
    make_move(piece.mesh, sequence.moves[i]);
  }
  piece.mesh.undo_to(mark);
  return vertices;
}

/// Tries the best sequences around v until one stays. \returns its length, 0 if none does
int improve_around(Workpiece& piece, Smoother& smoother, SequenceSearch& search, int v, const SearchLimits& limits) {
  constexpr double kGoodEnough = 0.7;
  const std::vector<Sequence> sequences = search.run({v}, limits);
  for (const Sequence& sequence : sequences) {
    search.count_trial();
    Trial trial(piece, smoother, touched_by(piece, sequence));
    make_sequence(piece, sequence);
    if (trial.keep(kGoodEnough, 0)) return sequence.length;
  }
  return 0;
}

}  // namespace

Trial::Trial(Workpiece& piece, Smoother& smoother, std::vector<int> vertices)
    : piece_(piece), smoother_(smoother), mark_(piece.mesh.mark()), vertices_(std::move(vertices)) {
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  for (const int v : vertices_) {
    positions_.push_back(piece_.mesh.positions[v]);
    faces_.push_back(piece_.face[v]);
    arcs_.push_back(piece_.arc[v]);
  }
  old_vertices_ = piece_.mesh.vertex_count();
  collect_quads();
  before_ = worst();
}

void Trial::collect_quads() {
  quads_.clear();
  for (const int v : vertices_) quads_.insert(quads_.end(), piece_.mesh.quads_at(v).begin(), piece_.mesh.quads_at(v).end());
  std::sort(quads_.begin(), quads_.end());
  quads_.erase(std::unique(quads_.begin(), quads_.end()), quads_.end());
}

double Trial::worst() const {
  double least = 1;
  for (const int q : quads_) least = std::min(least, smoother_.signed_quality(q));
  return least;
}

bool Trial::keep(double good_enough, double gain) {
  std::vector<int> inside;
  for (const int v : vertices_)
    if (piece_.mesh.valence(v) > 0) inside.push_back(v);
  for (int v = old_vertices_; v < piece_.mesh.vertex_count(); ++v) inside.push_back(v);
  smoother_.relax(inside, 2, 0.1);
  smoother_.relax(inside, 3, 1e-3);
  collect_quads();
  if (worst() >= std::min(before_ + gain, good_enough)) {
    piece_.mesh.forget_log();
    return true;
  }
  piece_.mesh.undo_to(mark_);
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    piece_.mesh.positions[vertices_[i]] = positions_[i];
    piece_.face[vertices_[i]] = faces_[i];
    piece_.arc[vertices_[i]] = arcs_[i];
  }
  collect_quads();
  smoother_.update_frames(quads_, true);
  return false;
}

int straighten_features(Workpiece& piece, Smoother& smoother, const RunContext& context) {
  constexpr SearchLimits kLimits{3, 30, 2.0, 6000, 6, 3};
  SequenceSearch search(piece.mesh, 40);
  int moves = 0;
  const int n = piece.mesh.vertex_count();
  for (int v = 0; v < n && !search.exhausted(); ++v) {
    if ((v & 255) == 0) context.checkpoint();
    if (has_straight_corner(piece.mesh, v)) moves += improve_around(piece, smoother, search, v, kLimits);
  }
  return moves;
}

int improve_valences(Workpiece& piece, Smoother& smoother, const RunContext& context) {
  constexpr SearchLimits kLimits{2, 3, 0.9, 400, 5, 3};
  constexpr int kPasses = 2;
  SequenceSearch search(piece.mesh, 80);
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
