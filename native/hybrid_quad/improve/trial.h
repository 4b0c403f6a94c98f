#pragma once

#include <functional>
#include <vector>

#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// A change on trial: what is around it, and how to get back. Take the trial, change the mesh, then `keep`: it relaxes the
/// vertices around and undoes everything if their quads became worse.
class Trial {
 public:
  /// How good some quads are together, the larger the better; empty: the quality of the worst.
  using Measure = std::function<double(const std::vector<int>& quads)>;

  Trial(Workpiece& piece, Smoother& smoother, std::vector<int> vertices, Measure measure = {});
  /// \returns whether the change stays: the quads around are better by `gain`, or at least `good_enough`
  bool keep(double good_enough, double gain);

 private:
  double measured() const;
  void collect_quads(const std::vector<int>& vertices);

  Workpiece& piece_;
  Smoother& smoother_;
  Measure measure_;
  std::size_t mark_;
  int old_vertices_ = 0;
  std::vector<int> vertices_, quads_;
  std::vector<Vector3> positions_;
  std::vector<int> faces_;
  std::vector<double> arcs_;
  double before_;
};

}  // namespace hybrid_quad
