#include "hybrid_quad/sizing/vertex_potentials.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/grid_algebra/quarter_turn.h"
#include "hybrid_quad/numerics/sparse_solve.h"

namespace hybrid_quad {

namespace {

/// The inverse of (a, b)^T; where a and b are nearly parallel, that of a triangle as flat as is borne.
Eigen::Matrix2d gradient_map(const Vector2& a, const Vector2& b) {
  constexpr double kFlattest = 1e-6;
  Eigen::Matrix2d rows;
  rows << a.transpose(), b.transpose();
  const double size = rows.squaredNorm();
  if (!(size > 0)) return Eigen::Matrix2d::Zero();
  if (std::abs(rows.determinant()) > kFlattest * size) return rows.inverse();
  return (rows.transpose() * rows + kFlattest * size * Eigen::Matrix2d::Identity()).inverse() * rows.transpose();
}

}  // namespace

VertexPotentials::VertexPotentials(const TriangleMesh& mesh, const FrameField& field, const CorrectionCosts& costs)
    : cut_(cut_to_disks(mesh, field.matching)) {
  gradient_.resize(mesh.face_count());
  for (int f = 0; f < mesh.face_count(); ++f)
    gradient_[f] = gradient_map(field.grid_vector(mesh, 3 * f), field.grid_vector(mesh, 3 * f + 1));
  for (const int v : cut_.node_vertex) place_.insert(place_.end(), 2, mesh.position(v));
  add_springs(mesh, field, costs);
}

void VertexPotentials::add_springs(const TriangleMesh& mesh, const FrameField& field, const CorrectionCosts& costs) {
  for (const int h : cut_.cut) {
    const int o = mesh.opposite(h);
    const double softness = CorrectionCosts::softness(field.grid_vector(mesh, h), costs.edge_weight(h / 3, o / 3));
    for (int row = 0; row < 2; ++row) {
      const TurnedCoordinate other = turned_coordinate(row, field.matching[o]);
      const double sign = other.sign;
      springs_.push_back({{unknown(TriangleMesh::next(h), row), unknown(h, row), unknown(TriangleMesh::next(o), other.source),
                           unknown(o, other.source)},
                          {1, -1, sign, -sign},
                          softness});
    }
  }
  for (int node = 0; node < 2 * mesh.face_count(); ++node) {
    const int h = costs.feature[node], row = node % 2;
    if (h < 0) continue;
    const double softness = CorrectionCosts::softness(field.grid_vector(mesh, h), costs.feature_weight);
    springs_.push_back({{unknown(TriangleMesh::next(h), row), unknown(h, row), 0, 0}, {1, -1, 0, 0}, softness});
  }
}

void VertexPotentials::assemble(const CorrectionCosts& costs, double lambda, SparseMatrix& matrix, Eigen::VectorXd& right_side) const {
  // Beside faces, whose stiffness is of the order of 1 to 100: firm to a ten thousandth of an edge. What is stiffer by far leaves nothing of a double's digits to
  // the rest, and turning the surface in space would then change the frames by a millionth.
  constexpr double kStiffest = 1e6;
  using Matrix23 = Eigen::Matrix<double, 2, 3>;
  const int n = static_cast<int>(place_.size()), faces = static_cast<int>(gradient_.size());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * static_cast<std::size_t>(faces) + 10 * springs_.size() + n);
  right_side = Eigen::VectorXd::Zero(n);
  // The lower triangle of what two unknowns have in common, called once a pair: twice of it on the diagonal where they are one.
  const auto add = [&](int a, int b, int i, int j, double value) {
    entries.emplace_back(std::max(i, j), std::min(i, j), i == j && a != b ? 2 * value : value);
  };
  Matrix23 growth;
  growth << -1, 1, 0, 0, -1, 1;
  for (int f = 0; f < faces; ++f) {
    const Matrix23 map = gradient_[f] * growth;
    for (int row = 0; row < 2; ++row) {
      const Matrix23 weighted = costs.stiffness[2 * f + row].asDiagonal() * map;
      const Eigen::Matrix3d element = map.transpose() * weighted;
      for (int a = 0; a < 3; ++a) {
        right_side[unknown(3 * f + a, row)] += weighted(row, a);
        for (int b = 0; b <= a; ++b) add(a, b, unknown(3 * f + a, row), unknown(3 * f + b, row), element(a, b));
      }
    }
  }
  for (const Spring& spring : springs_)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b <= a; ++b) {
        const double value = spring.coefficient[a] * spring.coefficient[b] / std::max(lambda * spring.softness, 1 / kStiffest);
        if (value != 0) add(a, b, spring.unknown[a], spring.unknown[b], value);
      }
  // Functions are known up to a constant: one value of each is held.
  for (const int node : cut_.piece_node)
    for (int row = 0; row < 2; ++row) entries.emplace_back(2 * node + row, 2 * node + row, 1.0);
  matrix.resize(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
}

void VertexPotentials::solve(const CorrectionCosts& costs, double lambda, std::vector<std::array<double, 4>>& x,
                             const RunContext& context) {
  SparseMatrix matrix;
  Eigen::VectorXd right_side;
  assemble(costs, lambda, matrix, right_side);
  if (!factor_) factor_.emplace(matrix, place_, context);
  const Eigen::VectorXd value = solve_sparse(matrix, right_side, *factor_, context);
  for (int f = 0; f < static_cast<int>(gradient_.size()); ++f)
    for (int row = 0; row < 2; ++row) {
      const double first = value[unknown(3 * f, row)], second = value[unknown(3 * f + 1, row)], third = value[unknown(3 * f + 2, row)];
      const Vector2 corrected = gradient_[f] * Vector2(second - first, third - second);
      x[f][2 * row] = corrected[0];
      x[f][2 * row + 1] = corrected[1];
    }
}

}  // namespace hybrid_quad
