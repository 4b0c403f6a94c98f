#include "hybrid_quad/spanning_parameterization/dislocations.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "hybrid_quad/spanning_parameterization/row_ends.h"

namespace hybrid_quad {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

enum class MoveEnd { kNone, kFace, kCone, kBoundary };

/// A dislocation's way: from a face over half-edges (each in the face that is left) to where it ends.
struct Move {
  double cost = kNever;
  int source = -1;
  int phase = 0;             ///< of a unit: 0 winds a, 1 winds b
  int version = 0;           ///< of the source's unit; a later search replaces this move
  IntVector2 burgers{0, 0};  ///< in the source's gauge
  MoveEnd end = MoveEnd::kNone;
  int end_face = -1;
  int end_halfedge = -1;  ///< kBoundary: the one that is left over; kCone: the cone's outgoing half-edge
  std::vector<int> crossed;
};

struct LaterMove {
  bool operator()(const Move& x, const Move& y) const {
    return std::tie(x.cost, x.source, x.phase) > std::tie(y.cost, y.source, y.phase);
  }
};

/// The unit dislocation of phase k (0: a, 1: b) that a Burgers vector holds, or zero.
IntVector2 unit_part(const IntVector2& burgers, int k) {
  const int n = windings(burgers)[k];
  const int s = n > 0 ? 1 : n < 0 ? -1 : 0;
  return k == 0 ? IntVector2{s, s} : IntVector2{s, -s};
}

class Canceller {
 public:
  Canceller(const SpanningOptions& options, const RunContext& context, MovableGrid& grid)
      : mesh_(grid.mesh()), frames_(grid.frames()), options_(options), context_(context), grid_(grid) {
    const int n = mesh_.face_count();
    distance_.assign(n, 0);
    arrived_.resize(n);
    over_.assign(n, -1);
    reached_.assign(n, 0);
    settled_.assign(n, 0);
    version_.assign(n, IntVector2{0, 0});
    budget_ = 1000000 + 100u * static_cast<unsigned>(std::min(n, 20000000));
  }

  void run() {
    for (int f = 0; f < mesh_.face_count(); ++f)
      if (!is_zero(grid_.burgers(f))) enqueue(f);
    drain();
  }

 private:
  /// The cheapest end that face t itself offers to what has arrived there.
  void look_for_end(int t, bool at_source, Move& best) const {
    const double d = distance_[t];
    const IntVector2& b = arrived_[t];
    if (!at_source && d < best.cost && cancels(t, b)) {
      best.cost = d;
      best.end = MoveEnd::kFace;
      best.end_face = t;
    }
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const int v = mesh_.from(h);
      if (mesh_.outgoing(v) == h && grid_.takes_in(v) && d + options_.cone_cost < best.cost) {
        best.cost = d + options_.cone_cost;
        best.end = MoveEnd::kCone;
        best.end_face = t;
        best.end_halfedge = h;
      }
      if (mesh_.opposite(h) < 0 && d + kFeatureCrossing < best.cost && grid_.may_cross(h, b)) {
        best.cost = d + kFeatureCrossing;
        best.end = MoveEnd::kBoundary;
        best.end_face = t;
        best.end_halfedge = h;
      }
    }
  }

  bool cancels(int t, const IntVector2& b) const {
    return unit_count(sum(grid_.burgers(t), b)) < unit_count(grid_.burgers(t)) + unit_count(b);
  }

  /// Shortest paths on the dual graph from `source`, the Burgers vector carried along, until nothing cheaper
  /// can come.
  Move search(int source, const IntVector2& burgers) {
    const double limit = grid_.longest_way(source);
    Move best;
    best.source = source;
    best.burgers = burgers;
    ++stamp_;
    heap_.clear();
    const auto later = std::greater<std::pair<double, int>>();
    const auto reach = [&](int f, double d, const IntVector2& b, int over) {
      if (reached_[f] == stamp_ && d >= distance_[f]) return;
      reached_[f] = stamp_;
      distance_[f] = d;
      arrived_[f] = b;
      over_[f] = over;
      heap_.push_back({d, f});
      std::push_heap(heap_.begin(), heap_.end(), later);
    };
    reach(source, 0, burgers, -1);
    while (!heap_.empty()) {
      const auto [d, t] = heap_.front();
      std::pop_heap(heap_.begin(), heap_.end(), later);
      heap_.pop_back();
      if (settled_[t] == stamp_) continue;
      if (d > limit || d >= best.cost) break;
      settled_[t] = stamp_;
      look_for_end(t, t == source, best);
      if ((++steps_ & 0x3fff) == 0) context_.checkpoint(0.4);
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int o = mesh_.opposite(h);
        if (o < 0 || settled_[o / 3] == stamp_ || !grid_.may_cross(h, arrived_[t])) continue;
        const double cost = d + grid_.step_length(t, o / 3) + (grid_.measure().axis[h] >= 0 ? kFeatureCrossing : 0);
        reach(o / 3, cost, turned(arrived_[t], frames_.matching[h]), h);
      }
    }
    if (best.cost > limit) best.end = MoveEnd::kNone;
    if (best.end != MoveEnd::kNone)
      best.crossed = path_to(best.end_face);
    else
      best.cost = kNever;
    return best;
  }

  /// Half-edges crossed from the last search's source to face t.
  std::vector<int> path_to(int t) const {
    std::vector<int> crossed;
    for (int h = over_[t]; h >= 0; h = over_[h / 3]) crossed.push_back(h);
    std::reverse(crossed.begin(), crossed.end());
    return crossed;
  }

  /// Whether a move found earlier still holds after what has changed since.
  bool still_holds(const Move& move) const {
    if (unit_count(sum(grid_.burgers(move.source), minus(move.burgers))) + unit_count(move.burgers) !=
        unit_count(grid_.burgers(move.source)))
      return false;
    IntVector2 b = move.burgers;
    for (const int h : move.crossed) {
      if (!grid_.may_cross(h, b)) return false;
      b = turned(b, frames_.matching[h]);
    }
    if (move.end == MoveEnd::kFace) return cancels(move.end_face, b);
    return move.end != MoveEnd::kBoundary || grid_.may_cross(move.end_halfedge, b);
  }

  IntVector2 carry(const std::vector<int>& crossed, IntVector2 b) {
    for (const int h : crossed) {
      grid_.cross(h, b);
      b = turned(b, frames_.matching[h]);
    }
    return b;
  }

  void perform(const Move& move) {
    const IntVector2 b = carry(move.crossed, move.burgers);
    if (move.end == MoveEnd::kBoundary) grid_.cross(move.end_halfedge, b);
    if (move.end == MoveEnd::kCone) grid_.take_in(move.end_halfedge, b);
  }

  void enqueue(int f, int phase) {
    const int version = ++version_[f][phase];
    const IntVector2 unit = unit_part(grid_.burgers(f), phase);
    if (is_zero(unit) || steps_ > budget_) return;
    Move move = search(f, unit);
    if (move.end == MoveEnd::kNone) return;
    move.phase = phase;
    move.version = version;
    queue_.push(std::move(move));
  }

  void enqueue(int f) {
    enqueue(f, 0);
    enqueue(f, 1);
  }

  /// Performs single moves, the shortest first, until none is left.
  void drain() {
    while (!queue_.empty()) {
      const Move move = queue_.top();
      queue_.pop();
      if (move.version != version_[move.source][move.phase]) continue;
      if (still_holds(move)) {
        perform(move);
        enqueue(move.source);
        if (move.end == MoveEnd::kFace) enqueue(move.end_face);
      } else {
        enqueue(move.source, move.phase);
      }
      context_.checkpoint(0.5);
    }
  }

  const TriangleMesh& mesh_;
  const FrameField& frames_;
  const SpanningOptions& options_;
  const RunContext& context_;
  MovableGrid& grid_;
  std::priority_queue<Move, std::vector<Move>, LaterMove> queue_;
  // Of the search, valid where the stamp is the current one.
  std::vector<double> distance_;
  std::vector<IntVector2> arrived_;
  std::vector<int> over_, reached_, settled_;
  std::vector<IntVector2> version_;  ///< by face and phase
  std::vector<std::pair<double, int>> heap_;
  int stamp_ = 0;
  unsigned steps_ = 0;   ///< faces settled in all searches
  unsigned budget_ = 0;  ///< of them: dislocations that are still there then stay
};

}  // namespace

void cancel_dislocations(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
                         const SpanningOptions& options, const RunContext& context, LiftedGrid& grid) {
  MovableGrid movable(surface, frames, measure, options.strip_rows, grid);
  Canceller(options, context, movable).run();
  cancel_row_ends(options, context, movable);
}

int count_dislocations(const TriangleMesh& mesh, const LiftedGrid& grid) {
  int count = 0;
  for (int f = 0; f < mesh.face_count(); ++f) count += unit_count(grid.burgers(f));
  return count;
}

}  // namespace hybrid_quad
