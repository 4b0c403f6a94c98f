#pragma once

#include <vector>

#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

/// Which extracted quads are better left alone: those around places that improving made flawed, though they were not
/// before. What is extracted lies on the surface without folds nearly everywhere; features that crowd within a quad can
/// leave no room to make it better.
class Restoration {
 public:
  Restoration(const QuadMesh& extracted, const SurfaceIndex& index, const Agreement& agreement, int threads = 1);

  int flawed_count() const { return flawed_count_; }  ///< of the extracted quads
  const std::vector<char>& locked() const { return locked_; }  ///< #Q of the extracted mesh
  int locked_count() const;
  /// Locks extracted quads near flawed ones of the improved mesh, further around where that was tried before.
  /// \returns whether any quad was locked that was not yet
  bool give_up_around(const QuadMesh& improved, const std::vector<int>& flawed);
  /// Locks extracted quads at these vertices of theirs, but flawed ones. \returns whether any was locked that was not yet
  bool give_up_at(const QuadMesh& extracted, const std::vector<int>& vertices);

 private:
  std::vector<Vector3> centre_;
  std::vector<double> reach_;        // how far a quad extends from its centre
  std::vector<char> locked_, flawed_;
  int flawed_count_ = 0;
  double mean_edge_ = 0;
  int rounds_ = 0;
};

}  // namespace hybrid_quad
