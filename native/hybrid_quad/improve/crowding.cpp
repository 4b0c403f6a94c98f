#include "hybrid_quad/improve/crowding.h"

#include <vector>

namespace hybrid_quad {

namespace {

double mean_square_side(const EditMesh& mesh, int q) {
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    sum += (mesh.positions[mesh.quad(q)[(i + 1) & 3]] - mesh.positions[mesh.quad(q)[i]]).squaredNorm();
  return sum / 4;
}

Vector3 mean_of_neighbours(const EditMesh& mesh, int v) {
  Vector3 sum = Vector3::Zero();
  for (const int q : mesh.quads_at(v)) {
    const int i = mesh.corner_of(q, v);
    sum += mesh.positions[mesh.quad(q)[(i + 1) & 3]] + mesh.positions[mesh.quad(q)[(i + 3) & 3]];
  }
  return sum / (2.0 * mesh.valence(v));
}

/// Free vertices of quads that are far smaller than those around, and of the quads beside them.
std::vector<int> crowded_vertices(const Workpiece& piece, const Smoother& smoother) {
  constexpr double kSmall = 0.08;  // of the area around
  std::vector<char> crowded(piece.mesh.vertex_count(), 0);
  for (int q = 0; q < piece.mesh.quad_count(); ++q)
    if (piece.mesh.alive(q) && mean_square_side(piece.mesh, q) < kSmall * smoother.frame(q).area)
      for (const int v : piece.mesh.quad(q)) crowded[v] = 1;
  std::vector<int> vertices;
  for (int v = 0; v < piece.mesh.vertex_count(); ++v) {
    bool beside = false;
    for (const int q : piece.mesh.quads_at(v))
      for (const int w : piece.mesh.quad(q)) beside |= crowded[w] != 0;
    if (beside && piece.mesh.is_free(v) && piece.face[v] >= 0) vertices.push_back(v);
  }
  return vertices;
}

}  // namespace

void spread_crowded(Workpiece& piece, const Smoother& smoother, const RunContext& context) {
  constexpr int kSweeps = 40;
  const std::vector<int> vertices = crowded_vertices(piece, smoother);
  for (int sweep = 0; sweep < kSweeps && !vertices.empty(); ++sweep) {
    context.checkpoint();
    for (const int v : vertices) {
      const SurfacePoint point = piece.walk(mean_of_neighbours(piece.mesh, v), piece.face[v]);
      piece.face[v] = point.face;
      piece.mesh.positions[v] = point.position;
    }
  }
}

}  // namespace hybrid_quad
