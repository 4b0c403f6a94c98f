#include "hybrid_quad/spanning_parameterization/strip_widths.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hybrid_quad/periodic_field/narrow_strips.h"

namespace hybrid_quad {

namespace {

/// Strips between features up to this many quads wide must keep their least number of rows.
constexpr double kGuardedWidth = 2.5;

}  // namespace

StripWidths::StripWidths(const TriangleMesh& mesh, const FrameField& frames, const GridMeasure& measure,
                         const LiftedGrid& grid, int least_rows)
    : least_rows_(least_rows) {
  const auto strips = find_strips(mesh, frames, measure, kGuardedWidth);
  std::vector<std::pair<int, Effect>> effects;
  for (const auto& chain : strips) {
    const int strip = static_cast<int>(width_.size());
    double width = 0;
    for (const StripEdge& e : chain) {
      width += Vector2(e.share[0], e.share[1]).dot(grid.across_half_edge(mesh, e.halfedge));
      effects.push_back({e.halfedge, {strip, {-e.share[0], -e.share[1]}}});
      const int o = mesh.opposite(e.halfedge);
      if (o >= 0) effects.push_back({o, {strip, turned(e.share, frames.matching[e.halfedge])}});
    }
    width_.push_back(static_cast<int>(std::lround(width)));
  }
  std::stable_sort(effects.begin(), effects.end(),
                   [](const auto& x, const auto& y) { return x.first < y.first; });
  first_.assign(mesh.halfedge_count() + 1, 0);
  for (const auto& e : effects) {
    ++first_[e.first + 1];
    effects_.push_back(e.second);
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h) first_[h + 1] += first_[h];
}

bool StripWidths::allow(int h, const IntVector2& b) const {
  for (int i = first_[h]; i < first_[h + 1]; ++i) {
    const int change = effects_[i].gain[0] * b[0] + effects_[i].gain[1] * b[1];
    if (change < 0 && width_[effects_[i].strip] + change < least_rows_) return false;
  }
  return true;
}

void StripWidths::cross(int h, const IntVector2& b) {
  for (int i = first_[h]; i < first_[h + 1]; ++i)
    width_[effects_[i].strip] += effects_[i].gain[0] * b[0] + effects_[i].gain[1] * b[1];
}

}  // namespace hybrid_quad
