#include "hybrid_quad/spanning_parameterization/row_ends.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "hybrid_quad/spanning_parameterization/closed_rows.h"
#include "hybrid_quad/spanning_parameterization/sign_gauge.h"

namespace hybrid_quad {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Quads that it costs to leave a cone with half a dislocation, which must find a second half.
constexpr double kHalfDislocation = 1.0;
int dot(const IntVector2& x, const IntVector2& y) { return x[0] * y[0] + x[1] * y[1]; }
int row_count(const IntVector2& burgers) { return std::abs(burgers[0]) + std::abs(burgers[1]); }
bool is_odd(const IntVector2& burgers) { return row_count(burgers) % 2 != 0; }

enum class End { kNone, kFace, kCone, kBoundary };

/// The way of one row's end. Faces and cones that hold row ends are sites: f, or #F + v.
struct Route {
  double cost = kNever;
  int from = -1;       ///< site
  int direction = 0;   ///< in the gauge of the first face
  int version = 0;     ///< of what started it; a later search replaces this route
  End end = End::kNone;
  int to = -1;         ///< site
  int end_face = -1;
  int end_halfedge = -1;     ///< kBoundary: the one left over
  std::vector<int> crossed;  ///< half-edges, each in the face that is left
};

struct LaterRoute {
  bool operator()(const Route& x, const Route& y) const {
    return std::tie(x.cost, x.from, x.direction) > std::tie(y.cost, y.from, y.direction);
  }
};

class RowEndCanceller {
 public:
  RowEndCanceller(const SpanningOptions& options, const RunContext& context, MovableGrid& grid)
      : mesh_(grid.mesh()), frames_(grid.frames()), options_(options), context_(context), grid_(grid) {
    const std::size_t states = 4 * static_cast<std::size_t>(mesh_.face_count());
    distance_.assign(states, 0);
    over_.assign(states, -1);
    reached_.assign(states, 0);
    settled_.assign(states, 0);
    budget_ = 1000000 + 100u * static_cast<unsigned>(std::min(mesh_.face_count(), 20000000));
  }

  void run() {
    for (int f = 0; f < mesh_.face_count(); ++f) enqueue(f);
    if (queue_.empty()) return;
    drain();
    pair_odd_cones();
    if (!all_even() || !can_make_jumps_even(mesh_, grid_.grid())) keep_what_fits();
    for (const auto& [v, burgers] : taken_) {
      if (is_zero(burgers)) continue;
      grid_.pretend(mesh_.outgoing(v) / 3, burgers);
      grid_.take_in(mesh_.outgoing(v), burgers);
    }
    make_jumps_even(mesh_, grid_.grid());
  }

 private:
  int site_of_cone(int v) const { return mesh_.face_count() + v; }
  bool is_cone(int site) const { return site >= mesh_.face_count(); }
  int cone(int site) const { return site - mesh_.face_count(); }
  int face_of(int site) const { return is_cone(site) ? mesh_.outgoing(cone(site)) / 3 : site; }
  IntVector2 taken(int v) const {
    const auto found = taken_.find(v);
    return found == taken_.end() ? IntVector2{0, 0} : found->second;
  }
  IntVector2 held(int site) const { return is_cone(site) ? taken(cone(site)) : grid_.burgers(site); }

  /// Whether a row's end that comes from `from` with direction d is welcome in face t with unit b.
  bool cancels(int from, int d, int t, const IntVector2& b) const {
    const IntVector2 there = from == t ? sum(grid_.burgers(t), minus(kUnitSteps[d])) : grid_.burgers(t);
    return dot(there, b) < 0;
  }

  /// The cheapest end that face t offers to unit b, which has come `d` quads from a face.
  void look_for_end(int t, const IntVector2& b, double d, Route& best) const {
    if (d > 0 && d < best.cost && cancels(best.from, best.direction, t, b)) end_at(d, End::kFace, t, t, best);
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const int v = mesh_.from(h);
      if (mesh_.outgoing(v) == h && grid_.takes_in(v)) {
        const double cost = d + (is_odd(taken(v)) ? 0 : options_.cone_cost + kHalfDislocation);
        if (cost < best.cost) end_at(cost, End::kCone, site_of_cone(v), t, best);
      }
      if (mesh_.opposite(h) < 0 && d + kFeatureCrossing < best.cost && grid_.may_cross(h, b)) {
        end_at(d + kFeatureCrossing, End::kBoundary, -1, t, best);
        best.end_halfedge = h;
      }
    }
  }

  /// For what comes from an odd cone: only what is odd too.
  void look_for_odd_end(int t, double d, Route& best) const {
    if (is_odd(grid_.burgers(t)) && d < best.cost) end_at(d, End::kFace, t, t, best);
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const int v = mesh_.from(h);
      if (mesh_.outgoing(v) == h && site_of_cone(v) != best.from && is_odd(taken(v)) && d < best.cost)
        end_at(d, End::kCone, site_of_cone(v), t, best);
    }
  }

  static void end_at(double cost, End end, int site, int face, Route& best) {
    best.cost = cost;
    best.end = end;
    best.to = site;
    best.end_face = face;
  }

  /// Shortest ways on the dual graph for a unit with each of the given directions at first.
  Route search(int from, int first_direction, int directions) {
    Route best;
    best.from = from;
    best.direction = first_direction;
    ++stamp_;
    heap_.clear();
    const auto later = std::greater<std::pair<double, int>>();
    const auto reach = [&](int state, double d, int over) {
      if (reached_[state] == stamp_ && d >= distance_[state]) return;
      reached_[state] = stamp_;
      distance_[state] = d;
      over_[state] = over;
      heap_.push_back({d, state});
      std::push_heap(heap_.begin(), heap_.end(), later);
    };
    for (int i = 0; i < directions; ++i) reach(4 * face_of(from) + (first_direction + i) % 4, 0, -1);
    const double longest = grid_.longest_way(face_of(from));
    int end_direction = 0;
    while (!heap_.empty()) {
      const auto [d, state] = heap_.front();
      std::pop_heap(heap_.begin(), heap_.end(), later);
      heap_.pop_back();
      if (settled_[state] == stamp_) continue;
      if (d > longest || d >= best.cost) break;
      settled_[state] = stamp_;
      const int t = state / 4;
      const IntVector2& b = kUnitSteps[state % 4];
      const double before = best.cost;
      if (is_cone(from))
        look_for_odd_end(t, d, best);
      else
        look_for_end(t, b, d, best);
      if (best.cost < before) end_direction = state % 4;
      if ((++steps_ & 0x3fff) == 0) context_.checkpoint(0.45);
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int o = mesh_.opposite(h);
        if (o < 0 || !grid_.may_cross(h, b)) continue;
        const int next = 4 * (o / 3) + direction_of(turned(b, frames_.matching[h]));
        const double crossing = grid_.measure().axis[h] >= 0 ? kFeatureCrossing : 0;
        if (settled_[next] != stamp_) reach(next, d + grid_.step_length(t, o / 3) + crossing, h);
      }
    }
    if (best.cost > longest) best.end = End::kNone;
    if (best.end != End::kNone) trace_back(4 * best.end_face + end_direction, best);
    return best;
  }

  void trace_back(int state, Route& route) const {
    while (over_[state] >= 0) {
      const int h = over_[state], back = mesh_.opposite(h);
      route.crossed.push_back(h);
      state = 4 * (h / 3) + direction_of(turned(kUnitSteps[state % 4], frames_.matching[back]));
    }
    route.direction = state % 4;
    std::reverse(route.crossed.begin(), route.crossed.end());
  }

  /// Whether features, strips and boundaries let a route through as things are now.
  bool is_open(const Route& route) const {
    IntVector2 b = kUnitSteps[route.direction];
    for (const int h : route.crossed) {
      if (!grid_.may_cross(h, b)) return false;
      b = turned(b, frames_.matching[h]);
    }
    return route.end != End::kBoundary || grid_.may_cross(route.end_halfedge, b);
  }

  /// Whether a route found earlier still does what it was found for.
  bool still_holds(const Route& route) const {
    if (dot(grid_.burgers(route.from), kUnitSteps[route.direction]) <= 0 || !is_open(route)) return false;
    if (route.end != End::kFace) return true;
    IntVector2 b = kUnitSteps[route.direction];
    for (const int h : route.crossed) b = turned(b, frames_.matching[h]);
    return cancels(route.from, route.direction, route.to, b);
  }

  /// What a site holds grows by b; a cone's part lies in its gauge's face, out of the way.
  void give(int site, const IntVector2& b) {
    if (!is_cone(site)) return;
    taken_[cone(site)] = sum(taken(cone(site)), b);
    grid_.pretend(face_of(site), minus(b));
  }

  void perform(const Route& route) {
    IntVector2 b = kUnitSteps[route.direction];
    give(route.from, minus(b));
    for (const int h : route.crossed) {
      grid_.cross(h, b);
      b = turned(b, frames_.matching[h]);
    }
    if (route.end == End::kBoundary) grid_.cross(route.end_halfedge, b);
    if (route.end == End::kCone) give(route.to, b);
  }

  void undo(const Route& route) {
    IntVector2 b = kUnitSteps[route.direction];
    std::vector<IntVector2> carried;
    for (const int h : route.crossed) {
      carried.push_back(b);
      b = turned(b, frames_.matching[h]);
    }
    if (route.end == End::kBoundary) grid_.cross(route.end_halfedge, minus(b));
    if (route.end == End::kCone) give(route.to, minus(b));
    for (std::size_t i = route.crossed.size(); i-- > 0;) grid_.cross(route.crossed[i], minus(carried[i]));
    give(route.from, kUnitSteps[route.direction]);
  }

  void enqueue(int f) {
    if (is_zero(grid_.burgers(f))) return;
    for (int d = 0; d < 4; ++d) {
      if (dot(grid_.burgers(f), kUnitSteps[d]) <= 0 || steps_ > budget_) continue;
      Route route = search(f, d, 1);
      if (route.end == End::kNone) continue;
      route.version = ++version_[4 * f + d];
      queue_.push(std::move(route));
    }
  }

  void drain() {
    while (!queue_.empty()) {
      const Route route = queue_.top();
      queue_.pop();
      if (route.version != version_[4 * route.from + route.direction]) continue;
      if (still_holds(route)) {
        perform(route);
        performed_.push_back(route);
        if (route.end == End::kFace && route.to != route.from) enqueue(route.to);
      }
      enqueue(route.from);
      context_.checkpoint(0.45);
    }
  }

  /// Cones with half a dislocation each: one gives its half to another.
  void pair_odd_cones() {
    std::vector<int> odd;
    for (const auto& [v, burgers] : taken_)
      if (is_odd(burgers)) odd.push_back(v);
    for (const int v : odd) {
      if (!is_odd(taken(v)) || steps_ > budget_) continue;
      Route route = search(site_of_cone(v), 0, 4);
      if (route.end == End::kNone) continue;
      perform(route);
      performed_.push_back(std::move(route));
    }
  }

  bool all_even() const {
    for (const Route& route : performed_)
      for (const int site : {route.from, route.to})
        if (site >= 0 && is_odd(held(site))) return false;
    return true;
  }

  /// Routes that share sites stand or fall together. \return for each route the number of its group
  std::vector<int> groups() const {
    std::map<int, int> root;
    const auto find = [&](int site) {
      while (root.at(site) != site) site = root[site] = root.at(root.at(site));
      return site;
    };
    for (const Route& route : performed_)
      for (const int site : {route.from, route.to}) root.emplace(site, site);
    for (const Route& route : performed_)
      if (route.to >= 0) root[find(route.to)] = find(route.from);
    std::vector<int> group;
    for (const Route& route : performed_) group.push_back(find(route.from));
    return group;
  }

  /// Takes all routes back, and then makes those groups of them again that leave nothing odd.
  void keep_what_fits() {
    const std::vector<int> group = groups();
    std::map<int, std::vector<int>> members;
    std::map<int, bool> is_whole;
    for (std::size_t i = 0; i < performed_.size(); ++i) {
      members[group[i]].push_back(static_cast<int>(i));
      bool& whole = is_whole.emplace(group[i], true).first->second;
      for (const int site : {performed_[i].from, performed_[i].to}) whole = whole && (site < 0 || !is_odd(held(site)));
    }
    for (std::size_t i = performed_.size(); i-- > 0;) undo(performed_[i]);
    std::vector<std::vector<int>> waiting;
    for (const auto& [root, routes] : members) {
      if (!is_whole[root] || try_routes(routes)) continue;
      // Two groups that are odd around the same loop are even together.
      for (auto other = waiting.begin();; ++other) {
        if (other == waiting.end()) {
          waiting.push_back(routes);
          break;
        }
        std::vector<int> both = *other;
        both.insert(both.end(), routes.begin(), routes.end());
        if (!try_routes(both)) continue;
        waiting.erase(other);
        break;
      }
      context_.checkpoint(0.48);
    }
    if (waiting.empty()) return;
    const GeneratingLoops loops(mesh_);
    for (const std::vector<int>& routes : waiting) try_routes(routes, &loops);
  }

  /// \param loops  around which a closed row may go to make things even, null: none may
  bool try_routes(const std::vector<int>& routes, const GeneratingLoops* loops = nullptr) {
    std::size_t done = 0;
    for (; done < routes.size() && is_open(performed_[routes[done]]); ++done) perform(performed_[routes[done]]);
    if (done == routes.size() && (can_make_jumps_even(mesh_, grid_.grid()) || (loops && loops->fit() && close_rows(routes, *loops))))
      return true;
    while (done > 0) undo(performed_[routes[--done]]);
    return false;
  }

  /// Makes the sums of jumps even around all loops by closed rows that start where one of the routes does.
  bool close_rows(const std::vector<int>& routes, const GeneratingLoops& loops) {
    constexpr std::size_t kMostFaces = 4;
    std::vector<int> faces;
    for (const int i : routes)
      if (faces.size() < kMostFaces) faces.push_back(face_of(performed_[i].from));
    std::vector<ClosedRow> closed;
    for (GeneratingLoops::Set odd = loops.odd(grid_.grid()); odd != 0; odd = loops.odd(grid_.grid())) {
      auto row = shortest_closed_row(grid_, loops, odd, faces, closed_row_states_, context_);
      if (!row || !carry(*row)) break;
      closed.push_back(std::move(*row));
    }
    if (can_make_jumps_even(mesh_, grid_.grid())) return true;
    for (; !closed.empty(); closed.pop_back()) carry_back(closed.back(), closed.back().crossed.size());
    return false;
  }

  /// \returns whether it went all the way around; where not, nothing has changed
  bool carry(const ClosedRow& row) {
    IntVector2 b = row.burgers;
    for (std::size_t i = 0; i < row.crossed.size(); ++i) {
      if (!grid_.may_cross(row.crossed[i], b)) {
        carry_back(row, i);
        return false;
      }
      grid_.cross(row.crossed[i], b);
      b = turned(b, frames_.matching[row.crossed[i]]);
    }
    return true;
  }

  void carry_back(const ClosedRow& row, std::size_t steps) {
    IntVector2 b = row.burgers;
    for (std::size_t i = 0; i < steps; ++i) {
      grid_.cross(row.crossed[i], minus(b));
      b = turned(b, frames_.matching[row.crossed[i]]);
    }
  }

  const TriangleMesh& mesh_;
  const FrameField& frames_;
  const SpanningOptions& options_;
  const RunContext& context_;
  MovableGrid& grid_;
  std::priority_queue<Route, std::vector<Route>, LaterRoute> queue_;
  std::map<int, int> version_;       ///< by 4 face + direction
  std::map<int, IntVector2> taken_;  ///< by cone, in the gauge of its outgoing half-edge's face
  std::vector<Route> performed_;
  // Of the search, by 4 face + direction, valid where the stamp is the current one.
  std::vector<double> distance_;
  std::vector<int> over_, reached_, settled_;
  std::vector<std::pair<double, int>> heap_;
  int stamp_ = 0;
  unsigned steps_ = 0;   ///< states settled in all searches
  unsigned budget_ = 0;  ///< of them: row ends that are still there then stay
  std::size_t closed_row_states_ = 2000000;  ///< for all closed rows together
};

}  // namespace

void cancel_row_ends(const SpanningOptions& options, const RunContext& context, MovableGrid& movable) {
  RowEndCanceller(options, context, movable).run();
}

}  // namespace hybrid_quad
