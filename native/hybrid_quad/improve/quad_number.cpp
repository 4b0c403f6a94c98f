#include "hybrid_quad/improve/quad_number.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "hybrid_quad/improve/sequence_search.h"
#include "hybrid_quad/improve/trial.h"
#include "hybrid_quad/improve/vertex_opening.h"

namespace hybrid_quad {

namespace {

constexpr double kValenceWeight = 0.15;  // a valence cost of one, against the logarithm of a length
constexpr double kAnyShape = -FlawMeasure::kMostForShapes;  // a gain that only flaws fall short of

/// Length asked for at v, 0 where it is not known.
double asked_at(const Workpiece& piece, const std::vector<double>& lengths, int v) {
  if (piece.face[v] >= 0) return lengths[piece.input.face(piece.face[v])[0]];
  if (piece.mesh.kind(v) == VertexKind::kCorner && piece.mesh.anchor(v) >= 0) return lengths[piece.mesh.anchor(v)];
  return 0;
}

double asked_around(const Workpiece& piece, const std::vector<double>& lengths, int q) {
  double asked = 0;
  for (const int v : piece.mesh.quad(q)) asked = std::max(asked, asked_at(piece, lengths, v));
  return asked > 0 ? asked : piece.h;
}

double area_of(const EditMesh& mesh, int q) {
  const auto& v = mesh.quad(q);
  return 0.5 * (mesh.positions[v[2]] - mesh.positions[v[0]]).cross(mesh.positions[v[3]] - mesh.positions[v[1]]).norm();
}

/// When vertices changed, and when a change around a quad failed: what failed fails again until something changes there.
class History {
 public:
  bool may_try(std::size_t what, const std::vector<int>& touched) {
    if (what >= failed_.size()) failed_.resize(what + 1, 0);
    return failed_[what] == 0 || std::any_of(touched.begin(), touched.end(), [&](int v) {
             return v < static_cast<int>(changed_.size()) && changed_[v] > failed_[what];
           });
  }
  void fail(std::size_t what) { failed_[what] = ++now_; }
  void change(const std::vector<int>& touched) {
    ++now_;
    for (const int v : touched) {
      if (v >= static_cast<int>(changed_.size())) changed_.resize(v + 1, 0);
      changed_[v] = now_;
    }
  }
  void forget_failures() { failed_.clear(); }

 private:
  std::vector<long long> failed_, changed_;
  long long now_ = 0;
};

/// Only some changes at a time, so that the cheapest are the cheapest still.
int most_at_once(int quads, int missing) {
  constexpr int kLeast = 2, kShare = 48;
  return std::min(missing, std::max(kLeast, quads / kShare));
}

template <class Change>
struct Candidate {
  double cost;
  std::size_t id;
  Change change;
};

template <class Change>
void sort_cheapest_first(std::vector<Candidate<Change>>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
}

class TakingOut {
 public:
  TakingOut(Workpiece& piece, Smoother& smoother, const FlawMeasure& measure, const QuadNumber& number, const RunContext& context)
      : piece_(piece),
        smoother_(smoother),
        measure_(measure),
        number_(number),
        context_(context),
        search_(piece.mesh, kEffort),
        quads_(piece.mesh.live_quads()) {}

  int run() {
    const int before = quads_;
    for (const double gain : {0.0, kAnyShape}) {
      if (gain == 0 && number_.is_on_the_way) continue;
      history_.forget_failures();
      while (quads_ > number_.wanted && (round_of_collapses(gain) > 0 || round_with_turns(gain) > 0)) {}
    }
    return before - quads_;
  }

 private:
  static constexpr int kEffort = 400;
  static constexpr int kWays = 4;  ///< to collapse a quad: two diagonals, alone and with what merges
  static constexpr SearchLimits kTurned{2, 30, -30, 400, 8, 40};

  int at_once() const { return most_at_once(quads_, quads_ - number_.wanted); }

  int round_of_collapses(double gain) {
    context_.checkpoint();
    std::vector<Candidate<Sequence>> candidates = collapses();
    sort_cheapest_first(candidates);
    std::vector<char> is_changed(piece_.mesh.vertex_count(), 0);
    int made = 0;
    const int most = at_once();
    for (const Candidate<Sequence>& candidate : candidates) {
      if (made >= most) break;
      if (!piece_.mesh.alive(candidate.change.moves[0].quad)) continue;
      Changed changed;
      if (!may_move(piece_.mesh, candidate.change.moves[0], &changed)) continue;
      const std::vector<int> touched = touched_by(piece_, candidate.change);
      if (std::any_of(touched.begin(), touched.end(), [&](int v) { return is_changed[v] != 0; })) continue;
      if (!history_.may_try(candidate.id, touched)) continue;
      if (!try_sequence(candidate.change, touched, gain)) {
        history_.fail(candidate.id);
        continue;
      }
      for (const int v : touched) is_changed[v] = 1;
      ++made;
    }
    return made;
  }

  /// Collapses that an edge has to turn for, at the smallest quads first.
  int round_with_turns(double gain) {
    std::vector<Candidate<int>> candidates;
    for (int q = 0; q < piece_.mesh.quad_count(); ++q)
      if (piece_.mesh.alive(q)) candidates.push_back({area_of(piece_.mesh, q), first_turned() + q, q});
    sort_cheapest_first(candidates);
    int made = 0;
    const int most = at_once();
    for (const Candidate<int>& candidate : candidates) {
      if (made >= most || search_.exhausted()) break;
      if (!piece_.mesh.alive(candidate.change)) continue;
      context_.checkpoint();
      const EditMesh::Quad corners = piece_.mesh.quad(candidate.change);
      if (!history_.may_try(candidate.id, {corners.begin(), corners.end()})) continue;
      if (turn_and_collapse(corners, gain))
        ++made;
      else
        history_.fail(candidate.id);
    }
    return made;
  }

  bool turn_and_collapse(const EditMesh::Quad& corners, double gain) {
    constexpr int kTrials = 6;
    int trials = 0;
    const std::vector<Sequence> sequences = search_.run({corners.begin(), corners.end()}, kTurned);
    for (const Sequence& sequence : sequences) {
      if (sequence.length < 2 || removed_by(sequence) == 0 || quads_ - removed_by(sequence) < number_.wanted) continue;
      if (++trials > kTrials) break;
      search_.count_trial();
      if (try_sequence(sequence, touched_by(piece_, sequence), gain)) return true;
    }
    return false;
  }

  bool try_sequence(const Sequence& sequence, const std::vector<int>& touched, double gain) {
    const int removed = removed_by(sequence);
    Trial trial(piece_, smoother_, touched, std::cref(measure_));
    make_sequence(piece_, sequence);
    if (!trial.keep(std::numeric_limits<double>::infinity(), gain)) return false;
    quads_ -= removed;
    history_.change(touched);
    return true;
  }

  /// Quads that a sequence removes. \pre it has one move, or none that merges
  int removed_by(const Sequence& sequence) const {
    if (sequence.length == 1) return 1 + static_cast<int>(merged_away(piece_.mesh, sequence.moves[0]).size());
    return static_cast<int>(std::count_if(sequence.moves.begin(), sequence.moves.begin() + sequence.length,
                                          [](const Move& move) { return move.collapses(); }));
  }
  std::size_t first_turned() const { return kWays * static_cast<std::size_t>(piece_.mesh.quad_count()); }

  std::vector<Candidate<Sequence>> collapses() {
    std::vector<Candidate<Sequence>> found;
    for (int q = 0; q < piece_.mesh.quad_count(); ++q)
      for (int way = 0; way < kWays && piece_.mesh.alive(q); ++way) {
        Sequence sequence;
        sequence.length = 1;
        sequence.moves[0] = {way < 2 ? Move::kCollapse : Move::kCollapseAndMerge, q, way & 1};
        Changed changed;
        if (!may_move(piece_.mesh, sequence.moves[0], &changed) || quads_ - removed_by(sequence) < number_.wanted) continue;
        sequence.cost = cost_of_move(piece_.mesh, sequence.moves[0], changed);
        found.push_back({cost_of(sequence), kWays * static_cast<std::size_t>(q) + way, sequence});
      }
    return found;
  }

  double cost_of(const Sequence& sequence) const {
    const Move& move = sequence.moves[0];
    const auto& corners = piece_.mesh.quad(move.quad);
    const double diagonal =
        (piece_.mesh.positions[corners[move.corner]] - piece_.mesh.positions[corners[(move.corner + 2) & 3]]).norm();
    const double asked = asked_around(piece_, number_.lengths, move.quad);
    return std::log(std::max(diagonal / asked, 1e-6)) + kValenceWeight * sequence.cost;
  }

  Workpiece& piece_;
  Smoother& smoother_;
  const FlawMeasure& measure_;
  const QuadNumber& number_;
  const RunContext& context_;
  SequenceSearch search_;
  History history_;
  int quads_;
};

class PuttingIn {
 public:
  PuttingIn(Workpiece& piece, Smoother& smoother, const FlawMeasure& measure, const QuadNumber& number, const RunContext& context)
      : piece_(piece), smoother_(smoother), measure_(measure), number_(number), context_(context), quads_(piece.mesh.live_quads()) {}

  int run() {
    const int before = quads_;
    for (const double gain : {0.0, kAnyShape}) {
      history_.forget_failures();
      while (quads_ < number_.wanted && round(gain) > 0) {}
    }
    return quads_ - before;
  }

 private:
  int round(double gain) {
    context_.checkpoint();
    std::vector<Candidate<VertexOpening>> candidates = cheapest_openings();
    sort_cheapest_first(candidates);
    std::vector<char> is_changed(piece_.mesh.vertex_count(), 0);
    const auto is_other = [&is_changed](int v) {  // than before this round, which adds vertices too
      return v >= static_cast<int>(is_changed.size()) || is_changed[v] != 0;
    };
    int made = 0;
    const int most = most_at_once(quads_, number_.wanted - quads_);
    for (const auto& [cost, id, opening] : candidates) {
      if (made >= most) break;
      const std::vector<int> touched = vertices_around(opening.vertex);
      if (std::any_of(touched.begin(), touched.end(), is_other)) continue;
      if (!history_.may_try(id, touched)) continue;
      Trial trial(piece_, smoother_, touched, std::cref(measure_));
      open_vertex(piece_, opening);
      if (!trial.keep(std::numeric_limits<double>::infinity(), gain)) {
        history_.fail(id);
        continue;
      }
      history_.change(touched);
      for (const int v : touched) is_changed[v] = 1;
      ++made;
      ++quads_;
    }
    return made;
  }

  /// The cheapest of every vertex.
  std::vector<Candidate<VertexOpening>> cheapest_openings() const {
    std::vector<Candidate<VertexOpening>> found;
    for (int v = 0; v < piece_.mesh.vertex_count(); ++v) {
      const std::vector<VertexOpening> openings = openings_of(piece_.mesh, v);
      if (openings.empty()) continue;
      double area = 0;
      for (const int q : piece_.mesh.quads_at(v)) area += area_of(piece_.mesh, q) / piece_.mesh.valence(v);
      const double asked = asked_around(piece_, number_.lengths, piece_.mesh.quads_at(v).front());
      const double size = -0.5 * std::log(std::max(area / (asked * asked), 1e-12));
      Candidate<VertexOpening> best{std::numeric_limits<double>::infinity(), static_cast<std::size_t>(v), {}};
      for (const VertexOpening& opening : openings) {
        const double cost = size + kValenceWeight * opening_cost(piece_.mesh, opening);
        if (cost < best.cost) best = {cost, best.id, opening};
      }
      found.push_back(best);
    }
    return found;
  }

  std::vector<int> vertices_around(int v) const {
    std::vector<int> around;
    for (const int q : piece_.mesh.quads_at(v)) around.insert(around.end(), piece_.mesh.quad(q).begin(), piece_.mesh.quad(q).end());
    return around;
  }

  Workpiece& piece_;
  Smoother& smoother_;
  const FlawMeasure& measure_;
  const QuadNumber& number_;
  const RunContext& context_;
  History history_;
  int quads_;
};

}  // namespace

int take_out_quads(Workpiece& piece, Smoother& smoother, const FlawMeasure& measure, const QuadNumber& number,
                   const RunContext& context) {
  return TakingOut(piece, smoother, measure, number, context).run();
}

int put_in_quads(Workpiece& piece, Smoother& smoother, const FlawMeasure& measure, const QuadNumber& number,
                 const RunContext& context) {
  return PuttingIn(piece, smoother, measure, number, context).run();
}

}  // namespace hybrid_quad
