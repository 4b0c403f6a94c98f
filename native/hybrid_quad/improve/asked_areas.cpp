#include "hybrid_quad/improve/asked_areas.h"

namespace hybrid_quad {

AskedAreas::AskedAreas(const TriangleMesh& mesh, const std::vector<double>& lengths) : squared_(mesh.face_count()) {
  for (int f = 0; f < mesh.face_count(); ++f) {
    double length = 0;
    for (const int v : mesh.face(f)) length += lengths[v] / 3;
    squared_[f] = length * length;
    called_for_ += mesh.area(f) / squared_[f];
  }
}

}  // namespace hybrid_quad
