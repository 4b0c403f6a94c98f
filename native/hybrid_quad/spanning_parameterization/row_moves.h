#pragma once

#include <limits>
#include <map>
#include <vector>

#include "hybrid_quad/spanning_parameterization/closed_rows.h"
#include "hybrid_quad/spanning_parameterization/movable_grid.h"

namespace hybrid_quad {

inline int dot(const IntVector2& x, const IntVector2& y) { return x[0] * y[0] + x[1] * y[1]; }

/// The way of one row's end. Faces and cones that hold row ends are sites: f, or #F + v.
struct RowRoute {
  enum class End { kNone, kFace, kCone, kBoundary };

  double cost = std::numeric_limits<double>::infinity();
  int from = -1;       ///< site
  int direction = 0;   ///< in the gauge of the first face
  int version = 0;     ///< of what started it; a later search replaces this route
  End end = End::kNone;
  int to = -1;         ///< site
  int end_face = -1;
  int end_halfedge = -1;     ///< kBoundary: the one left over
  std::vector<int> crossed;  ///< half-edges, each in the face that is left
};

/// A movable grid whose cones may hold half dislocations for a while, and single row ends that move in it.
class RowMoves {
 public:
  explicit RowMoves(MovableGrid& grid) : grid_(grid), mesh_(grid.mesh()) {}

  MovableGrid& grid() { return grid_; }
  const MovableGrid& grid() const { return grid_; }
  const std::map<int, IntVector2>& taken() const { return taken_; }
  IntVector2 taken(int v) const;
  int site_of_cone(int v) const { return mesh_.face_count() + v; }
  bool is_cone(int site) const { return site >= mesh_.face_count(); }
  int face_of(int site) const { return is_cone(site) ? mesh_.outgoing(site - mesh_.face_count()) / 3 : site; }
  IntVector2 held(int site) const;

  /// Whether a row's end that comes from `from` with direction d is welcome in face t with unit b.
  bool cancels(int from, int d, int t, const IntVector2& b) const;
  /// Whether features, strips and boundaries let a route through as things are now.
  bool is_open(const RowRoute& route) const;
  /// Whether a route found earlier still does what it was found for.
  bool still_holds(const RowRoute& route) const;

  void perform(const RowRoute& route);
  void undo(const RowRoute& route);
  /// \returns whether it went all the way around; where not, nothing has changed
  bool perform(const ClosedRow& row);
  void undo(const ClosedRow& row) { carry_back(row, row.crossed.size()); }
  /// Moves the cones that have taken whole dislocations so that the grid closes around them.
  void settle_cones();

 private:
  void give(int site, const IntVector2& b);
  void carry_back(const ClosedRow& row, std::size_t steps);

  MovableGrid& grid_;
  const TriangleMesh& mesh_;
  std::map<int, IntVector2> taken_;  ///< by cone, in the gauge of its outgoing half-edge's face
};

}  // namespace hybrid_quad
