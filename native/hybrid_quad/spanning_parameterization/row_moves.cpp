#include "hybrid_quad/spanning_parameterization/row_moves.h"

namespace hybrid_quad {

IntVector2 RowMoves::taken(int v) const {
  const auto found = taken_.find(v);
  return found == taken_.end() ? IntVector2{0, 0} : found->second;
}

IntVector2 RowMoves::held(int site) const {
  return is_cone(site) ? taken(site - mesh_.face_count()) : grid_.burgers(site);
}

bool RowMoves::cancels(int from, int d, int t, const IntVector2& b) const {
  const IntVector2 there = from == t ? sum(grid_.burgers(t), minus(kUnitSteps[d])) : grid_.burgers(t);
  return dot(there, b) < 0;
}

bool RowMoves::is_open(const RowRoute& route) const {
  IntVector2 b = kUnitSteps[route.direction];
  for (const int h : route.crossed) {
    if (!grid_.may_cross(h, b)) return false;
    b = turned(b, grid_.frames().matching[h]);
  }
  return route.end != RowRoute::End::kBoundary || grid_.may_cross(route.end_halfedge, b);
}

bool RowMoves::still_holds(const RowRoute& route) const {
  if (dot(grid_.burgers(route.from), kUnitSteps[route.direction]) <= 0 || !is_open(route)) return false;
  if (route.end != RowRoute::End::kFace) return true;
  IntVector2 b = kUnitSteps[route.direction];
  for (const int h : route.crossed) b = turned(b, grid_.frames().matching[h]);
  return cancels(route.from, route.direction, route.to, b);
}

/// What a site holds grows by b; a cone's part lies in its gauge's face, out of the way.
void RowMoves::give(int site, const IntVector2& b) {
  if (!is_cone(site)) return;
  const int v = site - mesh_.face_count();
  taken_[v] = sum(taken(v), b);
  grid_.pretend(face_of(site), minus(b));
}

void RowMoves::perform(const RowRoute& route) {
  IntVector2 b = kUnitSteps[route.direction];
  give(route.from, minus(b));
  for (const int h : route.crossed) {
    grid_.cross(h, b);
    b = turned(b, grid_.frames().matching[h]);
  }
  if (route.end == RowRoute::End::kBoundary) grid_.cross(route.end_halfedge, b);
  if (route.end == RowRoute::End::kCone) give(route.to, b);
}

void RowMoves::undo(const RowRoute& route) {
  IntVector2 b = kUnitSteps[route.direction];
  std::vector<IntVector2> carried;
  for (const int h : route.crossed) {
    carried.push_back(b);
    b = turned(b, grid_.frames().matching[h]);
  }
  if (route.end == RowRoute::End::kBoundary) grid_.cross(route.end_halfedge, minus(b));
  if (route.end == RowRoute::End::kCone) give(route.to, minus(b));
  for (std::size_t i = route.crossed.size(); i-- > 0;) grid_.cross(route.crossed[i], minus(carried[i]));
  give(route.from, kUnitSteps[route.direction]);
}

bool RowMoves::perform(const ClosedRow& row) {
  IntVector2 b = row.burgers;
  for (std::size_t i = 0; i < row.crossed.size(); ++i) {
    if (!grid_.may_cross(row.crossed[i], b)) {
      carry_back(row, i);
      return false;
    }
    grid_.cross(row.crossed[i], b);
    b = turned(b, grid_.frames().matching[row.crossed[i]]);
  }
  return true;
}

void RowMoves::carry_back(const ClosedRow& row, std::size_t steps) {
  IntVector2 b = row.burgers;
  for (std::size_t i = 0; i < steps; ++i) {
    grid_.cross(row.crossed[i], minus(b));
    b = turned(b, grid_.frames().matching[row.crossed[i]]);
  }
}

void RowMoves::settle_cones() {
  for (const auto& [v, burgers] : taken_) {
    if (is_zero(burgers)) continue;
    grid_.pretend(mesh_.outgoing(v) / 3, burgers);
    grid_.take_in(mesh_.outgoing(v), burgers);
  }
}

}  // namespace hybrid_quad
