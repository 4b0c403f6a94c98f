#include "hybrid_quad/spanning_parameterization/movable_grid.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

MovableGrid::MovableGrid(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
                         int least_rows, LiftedGrid& grid)
    : surface_(surface),
      mesh_(surface.mesh),
      frames_(frames),
      measure_(measure),
      grid_(grid),
      strips_(surface.mesh, frames, measure, grid, least_rows) {
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
  longest_way_ = std::max(8.0, 4 * std::sqrt(quads));
  near_counts_ = faces_near_counts(surface, frames);
  limit_near_counts(quads);
  allowed_ = allowed_counts(surface, measure);
}

/// So far that all of them together make or take no more than a quarter of the quads.
void MovableGrid::limit_near_counts(double quads) {
  constexpr double kShare = 0.25, kShortest = 8;
  int units = 0;
  for (int f = 0; f < mesh_.face_count(); ++f)
    if (!near_counts_.empty() && near_counts_[f]) units += unit_count(burgers_[f]);
  longest_near_counts_ = std::min(longest_way_, std::max(kShortest, 2 * kShare * quads / std::max(1, units)));
}

bool MovableGrid::may_cross(int h, const IntVector2& b) const {
  if (!strips_.allow(h, b)) return false;
  const int axis = measure_.axis[h];
  if (axis < 0) return true;
  if (b[1 - axis] != 0) return false;
  const int curve = surface_.features.halfedge_curve[h];
  const int shorter = b[axis] * along_sign(measure_, h), after = grid_.curve_count[curve] - shorter;
  return shorter > 0 ? after >= allowed_[curve].fewest : after <= allowed_[curve].most;
}

void MovableGrid::cross(int h, const IntVector2& b) {
  strips_.cross(h, b);
  grid_.jump[h] = sum(grid_.jump[h], minus(b));
  burgers_[h / 3] = sum(burgers_[h / 3], minus(b));
  const int axis = measure_.axis[h];
  if (axis >= 0) grid_.curve_count[surface_.features.halfedge_curve[h]] -= b[axis] * along_sign(measure_, h);
  const int o = mesh_.opposite(h);
  if (o < 0) return;
  const IntVector2 there = turned(b, frames_.matching[h]);
  grid_.jump[o] = sum(grid_.jump[o], there);
  burgers_[o / 3] = sum(burgers_[o / 3], there);
}

bool MovableGrid::takes_in(int v) const {
  return grid_.constraint[v] == GridConstraint::kCorner && (grid_.holonomy[v] & 1) && !surface_.features.on_feature[v];
}

void MovableGrid::take_in(int outgoing, const IntVector2& b) {
  // The cone's value moves by d with (1 - R) d = -b, R the turn around it.
  const int v = mesh_.from(outgoing), turn = grid_.holonomy[v];
  const IntVector2 d = turn == 1 ? IntVector2{-(b[0] + b[1]) / 2, (b[0] - b[1]) / 2}
                                 : IntVector2{(b[1] - b[0]) / 2, -(b[0] + b[1]) / 2};
  grid_.value[v] += Vector2(d[0], d[1]);
  grid_.jump[outgoing] = sum(grid_.jump[outgoing], sum(d, minus(turned(d, turn))));
  burgers_[outgoing / 3] = sum(burgers_[outgoing / 3], minus(b));
}

}  // namespace hybrid_quad
