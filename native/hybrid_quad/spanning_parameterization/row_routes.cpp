#include "hybrid_quad/spanning_parameterization/row_routes.h"

#include <algorithm>
#include <functional>

namespace hybrid_quad {

namespace {

/// Quads that it costs to leave a cone with half a dislocation, which must find a second half.
constexpr double kHalfDislocation = 1.0;

void end_at(double cost, RowRoute::End end, int site, int face, RowRoute& best) {
  best.cost = cost;
  best.end = end;
  best.to = site;
  best.end_face = face;
}

}  // namespace

RowRouteSearch::RowRouteSearch(const RowMoves& rows, double cone_cost, const RunContext& context)
    : rows_(rows), grid_(rows.grid()), mesh_(grid_.mesh()), cone_cost_(cone_cost), context_(context) {
  const std::size_t states = 4 * static_cast<std::size_t>(mesh_.face_count());
  distance_.assign(states, 0);
  over_.assign(states, -1);
  reached_.assign(states, 0);
  settled_.assign(states, 0);
  budget_ = 1000000 + 100u * static_cast<unsigned>(std::min(mesh_.face_count(), 20000000));
}

/// The cheapest end that face t offers to unit b, which has come `d` quads from a face.
void RowRouteSearch::look_for_end(int t, const IntVector2& b, double d, RowRoute& best) const {
  if (d > 0 && d < best.cost && rows_.cancels(best.from, best.direction, t, b)) end_at(d, RowRoute::End::kFace, t, t, best);
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    const int v = mesh_.from(h);
    if (mesh_.outgoing(v) == h && grid_.takes_in(v)) {
      const double cost = d + (is_odd(rows_.taken(v)) ? 0 : cone_cost_ + kHalfDislocation);
      if (cost < best.cost) end_at(cost, RowRoute::End::kCone, rows_.site_of_cone(v), t, best);
    }
    if (mesh_.opposite(h) < 0 && d + kFeatureCrossing < best.cost && grid_.may_cross(h, b)) {
      end_at(d + kFeatureCrossing, RowRoute::End::kBoundary, -1, t, best);
      best.end_halfedge = h;
    }
  }
}

/// For what comes from an odd cone: only what is odd too.
void RowRouteSearch::look_for_odd_end(int t, double d, RowRoute& best) const {
  if (is_odd(grid_.burgers(t)) && d < best.cost) end_at(d, RowRoute::End::kFace, t, t, best);
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    const int v = mesh_.from(h), site = rows_.site_of_cone(v);
    if (mesh_.outgoing(v) == h && site != best.from && is_odd(rows_.taken(v)) && d < best.cost)
      end_at(d, RowRoute::End::kCone, site, t, best);
  }
}

RowRoute RowRouteSearch::search(int from, int first_direction, int directions) {
  RowRoute best;
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
  const int first = rows_.face_of(from);
  for (int i = 0; i < directions; ++i) reach(4 * first + (first_direction + i) % 4, 0, -1);
  const double longest = grid_.longest_way(first);
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
    if (rows_.is_cone(from))
      look_for_odd_end(t, d, best);
    else
      look_for_end(t, b, d, best);
    if (best.cost < before) end_direction = state % 4;
    if ((++steps_ & 0x3fff) == 0) context_.checkpoint(0.45);
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const int o = mesh_.opposite(h);
      if (o < 0 || !grid_.may_cross(h, b)) continue;
      const int next = 4 * (o / 3) + direction_of(turned(b, grid_.frames().matching[h]));
      const double crossing = grid_.measure().axis[h] >= 0 ? kFeatureCrossing : 0;
      if (settled_[next] != stamp_) reach(next, d + grid_.step_length(t, o / 3) + crossing, h);
    }
  }
  if (best.cost > longest) best.end = RowRoute::End::kNone;
  if (best.end != RowRoute::End::kNone) trace_back(4 * best.end_face + end_direction, best);
  return best;
}

void RowRouteSearch::trace_back(int state, RowRoute& route) const {
  while (over_[state] >= 0) {
    const int h = over_[state], back = mesh_.opposite(h);
    route.crossed.push_back(h);
    state = 4 * (h / 3) + direction_of(turned(kUnitSteps[state % 4], grid_.frames().matching[back]));
  }
  route.direction = state % 4;
  std::reverse(route.crossed.begin(), route.crossed.end());
}

}  // namespace hybrid_quad
