#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/spanning_parameterization/movable_grid.h"

namespace hybrid_quad {

/// Loops of edges that generate the first homology of a surface, from a tree of its vertices and a tree of its faces that do
/// not cross (tree and cotree: Erickson and Whittlesey, Greedy optimal homotopy and homology generators, SODA 2005). A set of loops
/// is a number with a bit for each.
class GeneratingLoops {
 public:
  using Set = std::uint64_t;

  explicit GeneratingLoops(const TriangleMesh& mesh);

  /// Whether there are no more than fit.
  bool fit() const { return loops_ <= 64; }
  /// Those that the edge of half-edge h is part of.
  Set through(int h) const { return through_[h]; }
  /// Those around which the jumps' sums are odd, that is, Psi changes its sign.
  /// \pre sums around all faces and cones are even
  Set odd(const LiftedGrid& grid) const;

 private:
  struct TreeEdge {
    int vertex, parent, halfedge;  ///< which joins them, either way
  };
  const TriangleMesh& mesh_;
  std::vector<TreeEdge> tree_;  ///< parents first
  std::vector<int> closing_;    ///< the half-edge that closes each loop
  std::vector<Set> through_;
  std::size_t loops_ = 0;
};

/// A row of quads that closes, to be taken out or put in: what a row's end does that goes once around.
struct ClosedRow {
  IntVector2 burgers{0, 0};  ///< in the first face
  std::vector<int> crossed;  ///< half-edges, each in the face that is left
};

/// Sums, modulo two, of independent sets of loops.
class LoopSums {
 public:
  /// \returns whether the set is no sum of those before; then it is one more
  bool add(GeneratingLoops::Set flips);
  /// Those, by their number, that add up to a set; none if there are no such.
  std::optional<GeneratingLoops::Set> sum_for(GeneratingLoops::Set flips) const;
  std::size_t rank() const { return rows_.size(); }

 private:
  struct Row {
    GeneratingLoops::Set flips, of;  ///< of: the sets, by number, that it is the sum of
  };
  Row reduced(Row row) const;
  std::vector<Row> rows_;
};

/// Closed rows that together cross each of the wanted loops an odd number of times, and each other an even number; empty where there
/// are none near a face. They are taken from the shortest ones that start from that face, go around something, and come
/// back (a greedy system of loops, as in the paper above).
std::vector<ClosedRow> closed_rows_that_flip(const MovableGrid& grid, const GeneratingLoops& loops, GeneratingLoops::Set wanted,
                                             int face, const RunContext& context);

}  // namespace hybrid_quad
