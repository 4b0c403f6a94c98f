#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

std::array<PlaneDeviation, 3> plane_deviations(const TriangleMesh& mesh, const RunContext& context) {
  std::array<PlaneDeviation, 3> deviations;
  const double diagonal = mesh.diagonal();
  if (!(diagonal > 0)) return deviations;
  const SurfaceIndex index(mesh, {});
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vector3> positions = mesh.positions();
    for (Vector3& p : positions) p[axis] = -p[axis];
    // The image is as far from the surface as the surface from the image.
    const TriangleMesh image(std::move(positions), mesh.faces(), mesh.opposites());
    const DirectedDistance distance = directed_distance(image, index, context);
    deviations[axis] = {100 * distance.largest / diagonal, 100 * distance.mean / diagonal};
  }
  return deviations;
}

}  // namespace hybrid_quad
