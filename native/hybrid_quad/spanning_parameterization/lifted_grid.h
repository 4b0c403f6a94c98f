#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "hybrid_quad/periodic_field/grid_measure.h"
#include "hybrid_quad/periodic_field/periodic_field.h"

namespace hybrid_quad {

using IntVector2 = std::array<int, 2>;

/// Grid coordinates at the vertices with an integer jump for every half-edge: in face f, half-edge h from p
/// to q measures
///   turned(value[q], corner_turn[next h]) - turned(value[p], corner_turn[h]) + jump[h],
/// which is the opposite of what it measures from the other side. Jumps are in D2 (u + v even). The jumps of
/// a face sum to its Burgers vector: 0 unless a dislocation sits in it.
struct LiftedGrid {
  std::vector<Vector2> value;    ///< #V, (u, v) in the vertex gauge; constrained coordinates are integers
  std::vector<IntVector2> jump;  ///< 3 #F
  std::vector<GridConstraint> constraint;  ///< #V; cones count as corners
  std::vector<std::uint8_t> corner_turn;   ///< 3 #F
  std::vector<std::uint8_t> holonomy;      ///< #V
  std::vector<int> curve_count;            ///< #curves: quad edges along it, as lifted

  Vector2 across_half_edge(const TriangleMesh& mesh, int h) const {
    const int n = TriangleMesh::next(h);
    return turned(value[mesh.to(h)], corner_turn[n]) - turned(value[mesh.from(h)], corner_turn[h]) +
           Vector2(jump[h][0], jump[h][1]);
  }
  IntVector2 burgers(int f) const {
    return {jump[3 * f][0] + jump[3 * f + 1][0] + jump[3 * f + 2][0],
            jump[3 * f][1] + jump[3 * f + 1][1] + jump[3 * f + 2][1]};
  }
};

/// Windings of a and b around a face with that Burgers vector.
inline IntVector2 windings(const IntVector2& burgers) {
  return {(burgers[0] + burgers[1]) / 2, (burgers[0] - burgers[1]) / 2};
}
inline IntVector2 burgers_of(const IntVector2& windings) {
  return {windings[0] + windings[1], windings[0] - windings[1]};
}
/// Whether u + v is odd: across such a jump Psi changes its sign; such a Burgers vector ends an odd number of rows.
inline bool is_odd(const IntVector2& x) { return (x[0] + x[1]) % 2 != 0; }
/// Number of unit dislocations: |winding of a| + |winding of b|.
int unit_count(const IntVector2& burgers);

/// 0 for what is no number of use.
inline int rounded(double x) { return std::isfinite(x) && std::abs(x) < 1e9 ? static_cast<int>(std::lround(x)) : 0; }

/// Sets the jump on h's side and what follows from it on the other.
void set_jump(const TriangleMesh& mesh, const FrameField& frames, int h, const IntVector2& jump, LiftedGrid& grid);

/// Which way a feature half-edge's coordinate along the curve should grow: +1 or -1.
inline int along_sign(const GridMeasure& measure, int h) {
  return measure.along[h][measure.axis[h]] >= 0 ? 1 : -1;
}

/// The fewest quad edges that a feature curve may get.
int fewest_curve_edges(const FeatureCurve& curve);

/// Pins the cones of the field to grid points (afterwards: docs/decisions/0004), relaxes the others
/// around them, and chooses every edge's jump once, by rounding what the frames of both sides measure on
/// average. Feature edges get exactly nothing across, curves with an asked count that many quad edges, and those that
/// would vanish their fewest.
LiftedGrid lift(const WorkingSurface& surface, const FrameField& frames, const PeriodicField& field,
                const GridMeasure& measure);

}  // namespace hybrid_quad
