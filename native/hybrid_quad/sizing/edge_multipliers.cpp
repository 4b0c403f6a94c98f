#include "hybrid_quad/sizing/edge_multipliers.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/grid_algebra/quarter_turn.h"
#include "hybrid_quad/numerics/sparse_solve.h"

namespace hybrid_quad {

namespace {

Vector3 middle_of(const TriangleMesh& mesh, int h) { return 0.5 * (mesh.position(mesh.from(h)) + mesh.position(mesh.to(h))); }

}  // namespace

EdgeMultipliers::EdgeMultipliers(const TriangleMesh& mesh, const FrameField& field, const CorrectionCosts& costs) {
  terms_.resize(2 * mesh.face_count());
  term_count_.assign(2 * mesh.face_count(), 0);
  compliance_.reserve(mesh.halfedge_count());
  for (int f = 0; f < mesh.face_count(); ++f) {
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int o = mesh.opposite(h);
      if (o > h) add_edge(field, mesh, h, costs.edge_weight(f, o / 3));
    }
    for (int row = 0; row < 2; ++row) {
      const int h = costs.feature[2 * f + row];
      if (h < 0) continue;
      const Vector2 d = field.grid_vector(mesh, h);
      put(2 * f + row, add(CorrectionCosts::softness(d, costs.feature_weight), middle_of(mesh, h)), d);
    }
  }
}

int EdgeMultipliers::add(double softness, const Vector3& middle) {
  compliance_.push_back(softness);
  place_.push_back(middle);
  return static_cast<int>(compliance_.size()) - 1;
}

/// Both rows must agree across the edge: X_f d_f + turned(X_g d_g) = 0.
void EdgeMultipliers::add_edge(const FrameField& field, const TriangleMesh& mesh, int h, double weight) {
  const int o = mesh.opposite(h), f = h / 3, g = o / 3;
  const Vector2 here = field.grid_vector(mesh, h), there = field.grid_vector(mesh, o);
  for (int row = 0; row < 2; ++row) {
    const TurnedCoordinate other = turned_coordinate(row, field.matching[o]);
    const int constraint = add(CorrectionCosts::softness(here, weight), middle_of(mesh, h));
    put(2 * f + row, constraint, here);
    put(2 * g + other.source, constraint, other.sign * there);
  }
}

/// Lower triangle of  lambda * compliance + B stiffness^-1 B^T,  and B times the identity's rows.
void EdgeMultipliers::assemble(const CorrectionCosts& costs, double lambda, SparseMatrix& matrix, Eigen::VectorXd& right_side) const {
  const int n = static_cast<int>(compliance_.size());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(n + 10 * terms_.size());
  right_side = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, lambda * compliance_[i]);
  for (std::size_t node = 0; node < terms_.size(); ++node) {
    const Vector2 inverse = costs.stiffness[node].cwiseInverse();
    for (int a = 0; a < term_count_[node]; ++a) {
      const RowTerm& x = terms_[node][a];
      right_side[x.constraint] += x.coefficients[node % 2];
      for (int b = 0; b <= a; ++b) {
        const RowTerm& y = terms_[node][b];
        const double value = x.coefficients.dot(inverse.cwiseProduct(y.coefficients));
        entries.emplace_back(std::max(x.constraint, y.constraint), std::min(x.constraint, y.constraint), value);
      }
    }
  }
  matrix.resize(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
}

void EdgeMultipliers::solve(const CorrectionCosts& costs, double lambda, std::vector<std::array<double, 4>>& x,
                            const RunContext& context) const {
  SparseMatrix matrix;
  Eigen::VectorXd right_side;
  assemble(costs, lambda, matrix, right_side);
  const Eigen::VectorXd multiplier = solve_sparse(matrix, right_side, place_, context);
  for (std::size_t node = 0; node < terms_.size(); ++node) {
    Vector2 push = Vector2::Zero();
    for (int a = 0; a < term_count_[node]; ++a) push += multiplier[terms_[node][a].constraint] * terms_[node][a].coefficients;
    const int row = static_cast<int>(node % 2);
    const Vector2 corrected = Vector2::Unit(row) - push.cwiseQuotient(costs.stiffness[node]);
    x[node / 2][2 * row] = corrected[0];
    x[node / 2][2 * row + 1] = corrected[1];
  }
}

}  // namespace hybrid_quad
