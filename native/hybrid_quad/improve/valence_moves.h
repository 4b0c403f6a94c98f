#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/improve/quad_moves.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Sequences of up to three diagonal collapses and edge rotations where quads are straight at a feature, each kept only if
/// the quads around are not worse afterwards (locally smoothed). \returns number of moves made
int straighten_features(Workpiece& piece, Smoother& smoother, const RunContext& context);

/// The same around every irregular vertex, up to two moves each.
int improve_valences(Workpiece& piece, Smoother& smoother, const RunContext& context);

/// Moves around quads of bad shape that make the worst quad there clearly better, even where valences suffer a little.
int improve_shapes(Workpiece& piece, Smoother& smoother, const RunContext& context);

/// A change of connectivity on trial: what is around it, and how to get back. Take the trial, change the mesh, then
/// `keep`: it relaxes the vertices around and undoes everything if their quads became worse.
class Trial {
 public:
  Trial(Workpiece& piece, Smoother& smoother, std::vector<int> vertices);
  /// \returns whether the change stays: the worst quad around is better by `gain`, or at least `good_enough`
  bool keep(double good_enough, double gain);

 private:
  double worst() const;
  void collect_quads();

  Workpiece& piece_;
  Smoother& smoother_;
  std::size_t mark_;
  int old_vertices_ = 0;
  std::vector<int> vertices_, quads_;
  std::vector<Vector3> positions_;
  std::vector<int> faces_;
  std::vector<double> arcs_;
  double before_;
};

}  // namespace hybrid_quad
