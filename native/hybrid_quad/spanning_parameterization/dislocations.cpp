#include "hybrid_quad/spanning_parameterization/dislocations.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "hybrid_quad/spanning_parameterization/curve_counts.h"
#include "hybrid_quad/spanning_parameterization/strip_widths.h"

namespace hybrid_quad {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Quads that a slide over a feature costs: it skews the grid on the other side too.
constexpr double kFeatureCost = 0.3;
/// Partners tried for a dislocation that cannot go anywhere alone, and how often that is tried.
constexpr int kPartners = 8;
constexpr int kMostMerges = 200;

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

IntVector2 sum(const IntVector2& x, const IntVector2& y) { return {x[0] + y[0], x[1] + y[1]}; }
IntVector2 minus(const IntVector2& x) { return {-x[0], -x[1]}; }
bool is_zero(const IntVector2& x) { return x[0] == 0 && x[1] == 0; }

/// The unit dislocation of phase k (0: a, 1: b) that a Burgers vector holds, or zero.
IntVector2 unit_part(const IntVector2& burgers, int k) {
  const int n = windings(burgers)[k];
  const int s = n > 0 ? 1 : n < 0 ? -1 : 0;
  return k == 0 ? IntVector2{s, s} : IntVector2{s, -s};
}

class Canceller {
 public:
  Canceller(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
            const SpanningOptions& options, const RunContext& context, LiftedGrid& grid)
      : surface_(surface),
        mesh_(surface.mesh),
        frames_(frames),
        measure_(measure),
        options_(options),
        context_(context),
        grid_(grid),
        strips_(surface.mesh, frames, measure, grid) {
    const int n = mesh_.face_count();
    burgers_.resize(n);
    centre_.resize(n);
    scale_.resize(n);
    double quads = 0;
    for (int f = 0; f < n; ++f) {
      burgers_[f] = grid_.burgers(f);
      const auto& t = mesh_.face(f);
      centre_[f] = (mesh_.position(t[0]) + mesh_.position(t[1]) + mesh_.position(t[2])) / 3;
      const double density = frames_.du[f].cross(frames_.dv[f]).norm();
      scale_[f] = std::isfinite(density) ? std::sqrt(density) : 0;
      quads += std::isfinite(density) ? density * mesh_.area(f) : 0;
    }
    // Nothing on the surface is further away than a few times its size in quads; a longer way only shears it.
    longest_ = std::max(8.0, 4 * std::sqrt(quads));
    near_counts_ = faces_near_counts(surface, frames);
    limit_near_counts(quads);
    allowed_ = allowed_counts(surface, measure);
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
      if (!is_zero(burgers_[f])) enqueue(f);
    drain();
    for (int merges = 0; merges < kMostMerges && merge_once(); ++merges) drain();
  }

 private:
  /// Rows that a counted curve calls for end near it, however far they could go: else many run through the whole surface.
  double longest_from(int f) const {
    return near_counts_.empty() || !near_counts_[f] ? longest_ : longest_near_counts_;
  }

  /// So far that all of them together make or take no more than a quarter of the quads.
  void limit_near_counts(double quads) {
    constexpr double kShare = 0.25, kShortest = 8;
    int units = 0;
    for (int f = 0; f < mesh_.face_count(); ++f)
      if (!near_counts_.empty() && near_counts_[f]) units += unit_count(burgers_[f]);
    longest_near_counts_ = std::min(longest_, std::max(kShortest, 2 * kShare * quads / std::max(1, units)));
  }

  double step_length(int f, int g) const {
    return (centre_[f] - centre_[g]).norm() * 0.5 * (scale_[f] + scale_[g]);
  }

  /// Whether a dislocation may slide over half-edge h: over features only along them, no curve below its
  /// fewest edges or above its most, no strip below one quad.
  bool may_cross(int h, const IntVector2& b) const {
    if (!strips_.allow(h, b)) return false;
    if (measure_.axis[h] < 0) return true;
    if (b[1 - measure_.axis[h]] != 0) return false;
    const int curve = surface_.features.halfedge_curve[h];
    const int shorter = b[measure_.axis[h]] * along_sign(measure_, h), after = grid_.curve_count[curve] - shorter;
    return shorter > 0 ? after >= allowed_[curve].fewest : after <= allowed_[curve].most;
  }

  bool takes_in(int v) const {
    return grid_.constraint[v] == GridConstraint::kCorner && (grid_.holonomy[v] & 1) &&
           !surface_.features.on_feature[v];
  }

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
      if (mesh_.outgoing(v) == h && takes_in(v) && d + options_.cone_cost < best.cost) {
        best.cost = d + options_.cone_cost;
        best.end = MoveEnd::kCone;
        best.end_face = t;
        best.end_halfedge = h;
      }
      if (mesh_.opposite(h) < 0 && d + kFeatureCost < best.cost && may_cross(h, b)) {
        best.cost = d + kFeatureCost;
        best.end = MoveEnd::kBoundary;
        best.end_face = t;
        best.end_halfedge = h;
      }
    }
  }

  bool cancels(int t, const IntVector2& b) const {
    return unit_count(sum(burgers_[t], b)) < unit_count(burgers_[t]) + unit_count(b);
  }

  /// Shortest paths on the dual graph from `source`, the Burgers vector carried along, until nothing cheaper
  /// can come. \param visit  called with every settled face; may be empty
  Move search(int source, const IntVector2& burgers, double limit, const std::function<void(int)>& visit) {
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
      if (visit) visit(t);
      look_for_end(t, t == source, best);
      if ((++steps_ & 0x3fff) == 0) context_.checkpoint(0.4);
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int o = mesh_.opposite(h);
        if (o < 0 || settled_[o / 3] == stamp_ || !may_cross(h, arrived_[t])) continue;
        const double cost = d + step_length(t, o / 3) + (measure_.axis[h] >= 0 ? kFeatureCost : 0);
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
    if (unit_count(sum(burgers_[move.source], minus(move.burgers))) + unit_count(move.burgers) !=
        unit_count(burgers_[move.source]))
      return false;
    IntVector2 b = move.burgers;
    for (const int h : move.crossed) {
      if (!may_cross(h, b)) return false;
      b = turned(b, frames_.matching[h]);
    }
    if (move.end == MoveEnd::kFace) return cancels(move.end_face, b);
    return move.end != MoveEnd::kBoundary || may_cross(move.end_halfedge, b);
  }

  /// What leaves a face over h with Burgers vector b; the other side gets it.
  void cross(int h, const IntVector2& b) {
    strips_.cross(h, b);
    grid_.jump[h] = sum(grid_.jump[h], minus(b));
    burgers_[h / 3] = sum(burgers_[h / 3], minus(b));
    if (measure_.axis[h] >= 0)
      grid_.curve_count[surface_.features.halfedge_curve[h]] -= b[measure_.axis[h]] * along_sign(measure_, h);
    const int o = mesh_.opposite(h);
    if (o < 0) return;
    const IntVector2 there = turned(b, frames_.matching[h]);
    grid_.jump[o] = sum(grid_.jump[o], there);
    burgers_[o / 3] = sum(burgers_[o / 3], there);
  }

  IntVector2 carry(const std::vector<int>& crossed, IntVector2 b) {
    for (const int h : crossed) {
      cross(h, b);
      b = turned(b, frames_.matching[h]);
    }
    return b;
  }

  /// The cone moves by d with (1 - R) d = -b, R the turn around it: then the grid closes around it without b.
  void take_in(int outgoing, const IntVector2& b) {
    const int v = mesh_.from(outgoing), turn = grid_.holonomy[v];
    const IntVector2 d = turn == 1 ? IntVector2{-(b[0] + b[1]) / 2, (b[0] - b[1]) / 2}
                                   : IntVector2{(b[1] - b[0]) / 2, -(b[0] + b[1]) / 2};
    grid_.value[v] += Vector2(d[0], d[1]);
    grid_.jump[outgoing] = sum(grid_.jump[outgoing], sum(d, minus(turned(d, turn))));
    burgers_[outgoing / 3] = sum(burgers_[outgoing / 3], minus(b));
  }

  void perform(const Move& move) {
    const IntVector2 b = carry(move.crossed, move.burgers);
    if (move.end == MoveEnd::kBoundary) cross(move.end_halfedge, b);
    if (move.end == MoveEnd::kCone) take_in(move.end_halfedge, b);
  }

  void enqueue(int f, int phase) {
    const int version = ++version_[f][phase];
    const IntVector2 unit = unit_part(burgers_[f], phase);
    if (is_zero(unit) || steps_ > budget_) return;
    Move move = search(f, unit, longest_from(f), {});
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

  struct Meeting {
    int face = -1;
    double distance = 0;
    IntVector2 burgers{0, 0};
    std::vector<int> crossed;
  };

  /// Other dislocations within reach of the unit, nearest first; its own face counts.
  std::vector<Meeting> meetings(int f, const IntVector2& unit) {
    std::vector<Meeting> found;
    search(f, unit, longest_from(f), [&](int t) {
      if (!is_zero(burgers_[t]) && static_cast<int>(found.size()) < kPartners)
        found.push_back(Meeting{t, distance_[t], arrived_[t], {}});
    });
    for (Meeting& m : found) m.crossed = path_to(m.face);
    return found;
  }

  /// Two dislocations that meet and go on together.
  struct Merger {
    double cost = kNever;
    int source = -1;
    IntVector2 unit{0, 0};
    Meeting meeting;
    Move move;
  };

  /// What the unit at face f could do together with either unit part at the meeting's face.
  void try_meeting(int f, const IntVector2& unit, const Meeting& meeting, Merger& best) {
    for (int phase = 0; phase < 2; ++phase) {
      const IntVector2 rest = meeting.face == f ? sum(burgers_[f], minus(unit)) : burgers_[meeting.face];
      const IntVector2 partner = unit_part(rest, phase);
      const double limit = std::min(best.cost, longest_from(f));
      if (is_zero(partner) || meeting.distance >= limit) continue;
      const IntVector2 both = sum(meeting.burgers, partner);
      // Only (2, 0) and (0, 2) slide along features.
      if (unit_count(both) != 2 || (both[0] != 0 && both[1] != 0)) continue;
      burgers_[f] = sum(burgers_[f], minus(unit));
      Move move = search(meeting.face, both, limit - meeting.distance, {});
      burgers_[f] = sum(burgers_[f], unit);
      if (move.end == MoveEnd::kNone || meeting.distance + move.cost >= limit) continue;
      best = Merger{meeting.distance + move.cost, f, unit, meeting, std::move(move)};
    }
  }

  /// Brings two dislocations together where both at once can leave though neither can alone.
  bool merge_once() {
    Merger best;
    best.cost = longest_;
    for (int f = 0; f < mesh_.face_count(); ++f)
      for (int phase = 0; phase < 2; ++phase) {
        const IntVector2 unit = unit_part(burgers_[f], phase);
        if (is_zero(unit) || steps_ > budget_) continue;
        for (const Meeting& meeting : meetings(f, unit)) try_meeting(f, unit, meeting, best);
      }
    if (best.source < 0 || steps_ > budget_) return false;
    carry(best.meeting.crossed, best.unit);
    perform(best.move);
    enqueue(best.source);
    enqueue(best.meeting.face);
    if (best.move.end == MoveEnd::kFace) enqueue(best.move.end_face);
    return true;
  }

  const WorkingSurface& surface_;
  const TriangleMesh& mesh_;
  const FrameField& frames_;
  const GridMeasure& measure_;
  const SpanningOptions& options_;
  const RunContext& context_;
  LiftedGrid& grid_;
  StripWidths strips_;
  std::vector<IntVector2> burgers_;
  std::vector<Vector3> centre_;
  std::vector<double> scale_;  ///< quads a unit of length
  double longest_ = 0;
  double longest_near_counts_ = 0;
  std::vector<char> near_counts_;  ///< #F, or empty
  std::vector<CountRange> allowed_;  ///< #curves
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
  Canceller(surface, frames, measure, options, context, grid).run();
}

int count_dislocations(const TriangleMesh& mesh, const LiftedGrid& grid) {
  int count = 0;
  for (int f = 0; f < mesh.face_count(); ++f) count += unit_count(grid.burgers(f));
  return count;
}

}  // namespace hybrid_quad
