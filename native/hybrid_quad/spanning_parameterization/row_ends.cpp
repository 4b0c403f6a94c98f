#include "hybrid_quad/spanning_parameterization/row_ends.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "hybrid_quad/spanning_parameterization/closed_rows.h"
#include "hybrid_quad/spanning_parameterization/row_cycles.h"
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

  /// Takes all routes back, and then makes as many again as leave nothing odd, in the smallest sets that can.
  void keep_what_fits() {
    for (std::size_t i = performed_.size(); i-- > 0;) rows_.undo(performed_[i]);
    const GeneratingLoops loops(mesh_);
    std::vector<RowCycle> cycles = cycles_of(performed_);
    const auto is_hopeless = [&](const RowCycle& cycle) { return !try_cycle(cycle, loops); };
    cycles.erase(std::remove_if(cycles.begin(), cycles.end(), is_hopeless), cycles.end());
    if (!loops.fit() || can_make_jumps_even(mesh_, grid_.grid())) return;
    std::vector<GeneratingLoops::Set> flips;
    for (const RowCycle& cycle : cycles) flips.push_back(flipped_by(cycle, performed_, loops));
    const std::vector<int> left_out = cycles_to_leave_out(cycles, flips);
    for (const int k : left_out) take_back(cycles[k]);
    for (const int k : left_out)
      if (make(cycles[k]) && !close_rows(cycles[k], loops)) take_back(cycles[k]);
  }

  /// Makes a cycle's routes if that leaves fewer dislocations. Where loops cannot be told apart it must flip none.
  bool try_cycle(const RowCycle& cycle, const GeneratingLoops& loops) {
    context_.checkpoint(0.48);
    const int before = held_at_sites(cycle);
    if (!make(cycle)) return false;
    if (held_at_sites(cycle) < before && (loops.fit() || can_make_jumps_even(mesh_, grid_.grid()))) return true;
    take_back(cycle);
    return false;
  }

  /// \returns whether all routes were open; where not, none is made
  bool make(const RowCycle& cycle) {
    for (std::size_t i = 0; i < cycle.size(); ++i) {
      if (rows_.is_open(performed_[cycle[i]])) {
        rows_.perform(performed_[cycle[i]]);
        continue;
      }
      while (i > 0) rows_.undo(performed_[cycle[--i]]);
      return false;
    }
    return true;
  }

  void take_back(const RowCycle& cycle) {
    for (std::size_t i = cycle.size(); i-- > 0;) rows_.undo(performed_[cycle[i]]);
  }

  /// Row ends in the faces that a cycle's routes start and end in.
  int held_at_sites(const RowCycle& cycle) const {
    std::set<int> faces;
    for (const int i : cycle)
      for (const int site : {performed_[i].from, performed_[i].to})
        if (site >= 0 && !rows_.is_cone(site)) faces.insert(site);
    int held = 0;
    for (const int f : faces) held += std::abs(grid_.burgers(f)[0]) + std::abs(grid_.burgers(f)[1]);
    return held;
  }

  /// Makes the sums of jumps even around all loops by closed rows near where one of the cycle's routes starts.
  bool close_rows(const RowCycle& cycle, const GeneratingLoops& loops) {
    constexpr std::size_t kMostFaces = 4;
    const GeneratingLoops::Set odd = loops.odd(grid_.grid());
    for (std::size_t i = 0; i < std::min(kMostFaces, cycle.size()) && faces_left_ > 0; ++i) {
      faces_left_ -= mesh_.face_count();
      const int face = rows_.face_of(performed_[cycle[i]].from);
      const std::vector<ClosedRow> rows = closed_rows_that_flip(grid_, loops, odd, face, context_);
      std::size_t made = 0;
      while (made < rows.size() && rows_.perform(rows[made])) ++made;
      if (!rows.empty() && made == rows.size()) return true;
      while (made > 0) rows_.undo(rows[--made]);
    }
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
  std::ptrdiff_t faces_left_ = 2000000;  ///< for all searches for closed rows together
};

}  // namespace

void cancel_row_ends(const SpanningOptions& options, const RunContext& context, MovableGrid& movable) {
  RowEndCanceller(options, context, movable).run();
}

}  // namespace hybrid_quad
