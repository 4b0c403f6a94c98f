#include "hybrid_quad/spanning_parameterization/row_ends.h"

#include <map>
#include <queue>
#include <tuple>
#include <utility>

#include "hybrid_quad/spanning_parameterization/closed_rows.h"
#include "hybrid_quad/spanning_parameterization/row_moves.h"
#include "hybrid_quad/spanning_parameterization/row_routes.h"
#include "hybrid_quad/spanning_parameterization/sign_gauge.h"

namespace hybrid_quad {

namespace {

struct LaterRoute {
  bool operator()(const RowRoute& x, const RowRoute& y) const {
    return std::tie(x.cost, x.from, x.direction) > std::tie(y.cost, y.from, y.direction);
  }
};

class RowEndCanceller {
 public:
  RowEndCanceller(const SpanningOptions& options, const RunContext& context, MovableGrid& grid)
      : mesh_(grid.mesh()), context_(context), grid_(grid), rows_(grid), search_(rows_, options.cone_cost, context) {}

  void run() {
    for (int f = 0; f < mesh_.face_count(); ++f) enqueue(f);
    if (queue_.empty()) return;
    drain();
    pair_odd_cones();
    if (!all_even() || !can_make_jumps_even(mesh_, grid_.grid())) keep_what_fits();
    rows_.settle_cones();
    make_jumps_even(mesh_, grid_.grid());
  }

 private:
  void enqueue(int f) {
    if (is_zero(grid_.burgers(f))) return;
    for (int d = 0; d < 4; ++d) {
      if (dot(grid_.burgers(f), kUnitSteps[d]) <= 0 || search_.exhausted()) continue;
      RowRoute route = search_.from_face(f, d);
      if (route.end == RowRoute::End::kNone) continue;
      route.version = ++version_[4 * f + d];
      queue_.push(std::move(route));
    }
  }

  void drain() {
    while (!queue_.empty()) {
      const RowRoute route = queue_.top();
      queue_.pop();
      if (route.version != version_[4 * route.from + route.direction]) continue;
      if (rows_.still_holds(route)) {
        rows_.perform(route);
        performed_.push_back(route);
        if (route.end == RowRoute::End::kFace && route.to != route.from) enqueue(route.to);
      }
      enqueue(route.from);
      context_.checkpoint(0.45);
    }
  }

  /// Cones with half a dislocation each: one gives its half to another.
  void pair_odd_cones() {
    std::vector<int> odd;
    for (const auto& [v, burgers] : rows_.taken())
      if (is_odd(burgers)) odd.push_back(v);
    for (const int v : odd) {
      if (!is_odd(rows_.taken(v)) || search_.exhausted()) continue;
      RowRoute route = search_.from_odd_cone(v);
      if (route.end == RowRoute::End::kNone) continue;
      rows_.perform(route);
      performed_.push_back(std::move(route));
    }
  }

  bool all_even() const {
    for (const RowRoute& route : performed_)
      for (const int site : {route.from, route.to})
        if (site >= 0 && is_odd(rows_.held(site))) return false;
    return true;
  }

  /// Routes that share sites stand or fall together. \return for each route the number of its group
  std::vector<int> groups() const {
    std::map<int, int> root;
    const auto find = [&](int site) {
      while (root.at(site) != site) site = root[site] = root.at(root.at(site));
      return site;
    };
    for (const RowRoute& route : performed_)
      for (const int site : {route.from, route.to}) root.emplace(site, site);
    for (const RowRoute& route : performed_)
      if (route.to >= 0) root[find(route.to)] = find(route.from);
    std::vector<int> group;
    for (const RowRoute& route : performed_) group.push_back(find(route.from));
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
      for (const int site : {performed_[i].from, performed_[i].to})
        whole = whole && (site < 0 || !is_odd(rows_.held(site)));
    }
    for (std::size_t i = performed_.size(); i-- > 0;) rows_.undo(performed_[i]);
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

  /// \param loops  around which closed rows may go to make things even, null: none may
  bool try_routes(const std::vector<int>& routes, const GeneratingLoops* loops = nullptr) {
    std::size_t done = 0;
    for (; done < routes.size() && rows_.is_open(performed_[routes[done]]); ++done) rows_.perform(performed_[routes[done]]);
    if (done == routes.size()) {
      if (can_make_jumps_even(mesh_, grid_.grid())) return true;
      if (loops && loops->fit() && close_rows(routes, *loops)) return true;
    }
    while (done > 0) rows_.undo(performed_[routes[--done]]);
    return false;
  }

  /// Makes the sums of jumps even around all loops by closed rows that start where one of the routes does.
  bool close_rows(const std::vector<int>& routes, const GeneratingLoops& loops) {
    constexpr std::size_t kMostFaces = 4;
    std::vector<int> faces;
    for (const int i : routes)
      if (faces.size() < kMostFaces) faces.push_back(rows_.face_of(performed_[i].from));
    std::vector<ClosedRow> closed;
    for (auto odd = loops.odd(grid_.grid()); odd != 0; odd = loops.odd(grid_.grid())) {
      auto row = shortest_closed_row(grid_, loops, odd, faces, closed_row_states_, context_);
      if (!row || !rows_.perform(*row)) break;
      closed.push_back(std::move(*row));
    }
    if (can_make_jumps_even(mesh_, grid_.grid())) return true;
    for (; !closed.empty(); closed.pop_back()) rows_.undo(closed.back());
    return false;
  }

  const TriangleMesh& mesh_;
  const RunContext& context_;
  MovableGrid& grid_;
  RowMoves rows_;
  RowRouteSearch search_;
  std::priority_queue<RowRoute, std::vector<RowRoute>, LaterRoute> queue_;
  std::map<int, int> version_;  ///< by 4 face + direction
  std::vector<RowRoute> performed_;
  std::size_t closed_row_states_ = 2000000;  ///< for all closed rows together
};

}  // namespace

void cancel_row_ends(const SpanningOptions& options, const RunContext& context, MovableGrid& movable) {
  RowEndCanceller(options, context, movable).run();
}

}  // namespace hybrid_quad
