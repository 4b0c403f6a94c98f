#pragma once

#include <utility>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/spanning_parameterization/row_moves.h"

namespace hybrid_quad {

/// Finds the shortest ways of row ends: Dijkstra on faces with directions, with a budget for all searches together.
class RowRouteSearch {
 public:
  /// \param cone_cost  quads that it costs to end at a cone
  RowRouteSearch(const RowMoves& rows, double cone_cost, const RunContext& context);

  /// The cheapest end for one row of what face f holds: a face that holds the opposite, a cone, or the boundary.
  RowRoute from_face(int f, int direction) { return search(f, direction, 1); }
  /// The nearest place with an odd number of row ends for half a dislocation that the cone at v has.
  RowRoute from_odd_cone(int v) { return search(rows_.site_of_cone(v), 0, 4); }
  /// Row ends that are still there then stay.
  bool exhausted() const { return steps_ > budget_; }

 private:
  RowRoute search(int from, int first_direction, int directions);
  void look_for_end(int t, const IntVector2& b, double d, RowRoute& best) const;
  void look_for_odd_end(int t, double d, RowRoute& best) const;
  void trace_back(int state, RowRoute& route) const;

  const RowMoves& rows_;
  const MovableGrid& grid_;
  const TriangleMesh& mesh_;
  double cone_cost_;
  const RunContext& context_;
  // By 4 face + direction, valid where the stamp is the current one.
  std::vector<double> distance_;
  std::vector<int> over_, reached_, settled_;
  std::vector<std::pair<double, int>> heap_;
  int stamp_ = 0;
  unsigned steps_ = 0;   ///< states settled in all searches
  unsigned budget_ = 0;
};

}  // namespace hybrid_quad
