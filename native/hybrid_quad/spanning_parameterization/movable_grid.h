#pragma once

#include <vector>

#include "hybrid_quad/spanning_parameterization/curve_counts.h"
#include "hybrid_quad/spanning_parameterization/lifted_grid.h"
#include "hybrid_quad/spanning_parameterization/strip_widths.h"

namespace hybrid_quad {

inline IntVector2 sum(const IntVector2& x, const IntVector2& y) { return {x[0] + y[0], x[1] + y[1]}; }
inline IntVector2 minus(const IntVector2& x) { return {-x[0], -x[1]}; }
inline bool is_zero(const IntVector2& x) { return x[0] == 0 && x[1] == 0; }

/// The steps of one quad, by their direction: 0 along u, counterclockwise.
inline constexpr IntVector2 kUnitSteps[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
inline int direction_of(const IntVector2& unit) {
  return unit[0] != 0 ? (unit[0] > 0 ? 0 : 2) : (unit[1] > 0 ? 1 : 3);
}

/// Quads that a slide over a feature costs: it skews the grid on the other side too.
constexpr double kFeatureCrossing = 0.3;

/// A lifted grid whose dislocations move from face to face by changes of jumps, with all that bounds them: features are
/// crossed only along themselves, curves keep as many edges as they may have, strips between features their least number
/// of rows.
class MovableGrid {
 public:
  MovableGrid(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure, int least_rows,
              LiftedGrid& grid);

  const IntVector2& burgers(int f) const { return burgers_[f]; }
  /// As if the Burgers vector of face f had grown by b: for trying things out.
  void pretend(int f, const IntVector2& b) { burgers_[f] = sum(burgers_[f], b); }
  /// From the centre of face f to that of its neighbour g, in quads.
  double step_length(int f, int g) const {
    return (centre_[f] - centre_[g]).norm() * 0.5 * (scale_[f] + scale_[g]);
  }
  /// How far what starts in face f may go, in quads. Nothing on the surface is further away than a few times its size; a
  /// longer way only shears it. Rows that a counted curve calls for end near it: else many run through the whole surface.
  double longest_way(int f) const {
    return near_counts_.empty() || !near_counts_[f] ? longest_way_ : longest_near_counts_;
  }
  /// Whether a dislocation may leave its face over half-edge h.
  bool may_cross(int h, const IntVector2& b) const;
  /// What leaves a face over h with Burgers vector b; the other side gets it.
  void cross(int h, const IntVector2& b);
  /// Whether the cone at v can take in dislocations: an odd one away from features.
  bool takes_in(int v) const;
  /// Moves the cone from which `outgoing`, its gauge's half-edge, leaves so that the grid closes around it without b.
  /// \param b  of even sum, in the gauge of the half-edge's face, which holds it
  void take_in(int outgoing, const IntVector2& b);

  const TriangleMesh& mesh() const { return mesh_; }
  const FrameField& frames() const { return frames_; }
  const GridMeasure& measure() const { return measure_; }
  LiftedGrid& grid() { return grid_; }

 private:
  void limit_near_counts(double quads);

  const WorkingSurface& surface_;
  const TriangleMesh& mesh_;
  const FrameField& frames_;
  const GridMeasure& measure_;
  LiftedGrid& grid_;
  StripWidths strips_;
  std::vector<IntVector2> burgers_;
  std::vector<Vector3> centre_;
  std::vector<double> scale_;  ///< quads a unit of length
  double longest_way_ = 0, longest_near_counts_ = 0;
  std::vector<char> near_counts_;    ///< #F, or empty
  std::vector<CountRange> allowed_;  ///< #curves
};

}  // namespace hybrid_quad
