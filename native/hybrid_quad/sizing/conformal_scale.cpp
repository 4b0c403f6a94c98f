#include "hybrid_quad/sizing/conformal_scale.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/frame_field/frame_topology.h"
#include "hybrid_quad/numerics/sparse_solve.h"
#include "hybrid_quad/sizing/cotangent.h"

namespace hybrid_quad {

std::vector<double> conformal_length_factor(const WorkingSurface& surface, const FrameField& field, double clip,
                                            const RunContext& context) {
  const TriangleMesh& mesh = surface.mesh;
  const FaceAngles angles(mesh);
  const std::vector<double> directions = frame_directions(mesh, field.du, field.dv);
  const int n = mesh.vertex_count();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(n), diagonal = Eigen::VectorXd::Constant(n, 1e-8);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o < h || surface.features.is_feature(h)) continue;
    const double weight = std::max(0.5 * (cotangent(mesh, h) + cotangent(mesh, o)), 1e-2);
    const double turn = turn_across(mesh, angles, directions, h).angle;
    const int p = mesh.from(h), q = mesh.to(h);
    entries.emplace_back(std::max(p, q), std::min(p, q), -weight);
    diagonal[p] += weight;
    diagonal[q] += weight;
    right_side[p] += turn;
    right_side[q] -= turn;
  }
  for (int v = 0; v < n; ++v) entries.emplace_back(v, v, diagonal[v]);
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd log_length = solve_sparse(matrix, right_side, mesh.positions(), context);

  std::vector<double> factor(mesh.face_count());
  double mean = 0, total = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto& t = mesh.face(f);
    factor[f] = (log_length[t[0]] + log_length[t[1]] + log_length[t[2]]) / 3;
    const double area = mesh.area(f);
    mean += area * factor[f];
    total += area;
  }
  if (total > 0) mean /= total;
  const double limit = std::log(clip);
  for (double& x : factor) x = std::exp(std::clamp(x - mean, -limit, limit));
  return factor;
}

}  // namespace hybrid_quad
