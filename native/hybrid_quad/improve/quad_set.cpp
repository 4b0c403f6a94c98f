#include "hybrid_quad/improve/quad_set.h"

#include <algorithm>

#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

QuadSet::QuadSet(const EditMesh& mesh, const std::vector<int>& quads) : mesh_(mesh) {
  for (const int q : quads) {
    const EditMesh::Quad& v = mesh.quad(q);
    Ball ball{q, Vector3::Zero(), 0};
    for (const int corner : v) ball.centre += 0.25 * mesh.positions[corner];
    for (const int corner : v) ball.radius = std::max(ball.radius, (mesh.positions[corner] - ball.centre).norm());
    balls_.push_back(ball);
  }
}

QuadSet::Place QuadSet::nearest(const Vector3& p) const {
  constexpr double kLess = 1 - 1e-9;
  Place best;
  for (const Ball& ball : balls_) {
    if ((ball.centre - p).norm() - ball.radius > best.distance) continue;
    const EditMesh::Quad& v = mesh_.quad(ball.quad);
    for (const int second : {1, 2}) {
      const Vector3 at = nearest_on_triangle(p, mesh_.positions[v[0]], mesh_.positions[v[second]], mesh_.positions[v[second + 1]]);
      const double distance = (at - p).norm();
      if (distance < kLess * best.distance) best = {ball.quad, second, at, distance};
    }
  }
  return best;
}

}  // namespace hybrid_quad
