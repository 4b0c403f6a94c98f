#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Areas that quads are to have where edge lengths are asked for: squared lengths, all scaled alike so that as many quads as
/// there are cover the surface.
class AskedAreas {
 public:
  AskedAreas() = default;
  /// \param lengths  #V of `mesh`, positive
  AskedAreas(const TriangleMesh& mesh, const std::vector<double>& lengths);

  bool empty() const { return squared_.empty(); }
  void set_number_of_quads(int quads) { scale_ = quads > 0 ? called_for_ / quads : 1; }
  double at(int face) const { return scale_ * squared_[face]; }

 private:
  std::vector<double> squared_;  ///< #F: asked lengths
  double called_for_ = 0;        ///< quads, by these lengths
  double scale_ = 1;
};

}  // namespace hybrid_quad
