#include "hybrid_quad/periodic_field/phase_matrix.h"

#include <cmath>

namespace hybrid_quad {

namespace {

using Matrix4 = Eigen::Matrix4d;

Eigen::Vector4d as_vector(const PhasePair& z) { return {z.a.real(), z.a.imag(), z.b.real(), z.b.imag()}; }
PhasePair as_pair(const Eigen::Vector4d& y) { return {{y[0], y[1]}, {y[2], y[3]}}; }

/// The transport as a real 4 x 4 matrix.
Matrix4 matrix_of(const PhaseTransport& t) {
  Matrix4 m;
  for (int c = 0; c < 4; ++c) m.col(c) = as_vector(transported(t, as_pair(Eigen::Vector4d::Unit(c))));
  return m;
}

}  // namespace

int constraint_dimension(GridConstraint constraint) {
  return constraint == GridConstraint::kFree ? 4 : constraint == GridConstraint::kCorner ? 1 : 2;
}

Eigen::Matrix4d constraint_basis(GridConstraint constraint) {
  if (constraint == GridConstraint::kFree) return Matrix4::Identity();
  const double s = std::sqrt(0.5);
  Matrix4 basis = Matrix4::Zero();
  basis(0, 0) = basis(2, 0) = s;
  if (constraint == GridConstraint::kCorner) return basis;
  basis(1, 1) = s;
  basis(3, 1) = constraint == GridConstraint::kIsolineV ? s : -s;
  return basis;
}

PhaseMatrix assemble_phase_matrix(const PhaseGraph& graph) {
  PhaseMatrix result;
  const int n = graph.node_count();
  result.offset.assign(n + 1, 0);
  for (int i = 0; i < n; ++i)
    result.offset[i + 1] = result.offset[i] + constraint_dimension(graph.constraint[i]);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(8 * graph.edges.size() + 6 * static_cast<std::size_t>(n));
  const auto put = [&](int row_node, int column_node, const Matrix4& block) {
    const int rows = result.offset[row_node + 1] - result.offset[row_node];
    const int columns = result.offset[column_node + 1] - result.offset[column_node];
    for (int c = 0; c < columns; ++c)
      for (int r = row_node == column_node ? c : 0; r < rows; ++r)
        if (block(r, c) != 0)
          entries.emplace_back(result.offset[row_node] + r, result.offset[column_node] + c, block(r, c));
  };
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector4d weight(graph.weight_a[i], graph.weight_a[i], graph.weight_b[i], graph.weight_b[i]);
    const Matrix4 basis = constraint_basis(graph.constraint[i]);
    // A tiny diagonal keeps nodes without edges from making the matrix singular in its pattern.
    put(i, i, basis.transpose() * weight.asDiagonal() * basis + 1e-14 * Matrix4::Identity());
  }
  for (const PhaseEdge& e : graph.edges)
    put(e.to, e.from,
        -(constraint_basis(graph.constraint[e.to]).transpose() * matrix_of(e.transport) *
          constraint_basis(graph.constraint[e.from])));
  result.lower.resize(result.offset[n], result.offset[n]);
  result.lower.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::VectorXd unknowns_of(const PhaseGraph& graph, const PhaseMatrix& matrix,
                            const std::vector<PhasePair>& z) {
  Eigen::VectorXd y(matrix.offset.back());
  for (int i = 0; i < graph.node_count(); ++i) {
    const Eigen::Vector4d local = constraint_basis(graph.constraint[i]).transpose() * as_vector(z[i]);
    for (int d = matrix.offset[i]; d < matrix.offset[i + 1]; ++d) y[d] = local[d - matrix.offset[i]];
  }
  return y;
}

std::vector<PhasePair> phases_of(const PhaseGraph& graph, const PhaseMatrix& matrix,
                                 const Eigen::VectorXd& y) {
  std::vector<PhasePair> z(graph.node_count());
  for (int i = 0; i < graph.node_count(); ++i) {
    Eigen::Vector4d local = Eigen::Vector4d::Zero();
    for (int d = matrix.offset[i]; d < matrix.offset[i + 1]; ++d) local[d - matrix.offset[i]] = y[d];
    z[i] = as_pair(constraint_basis(graph.constraint[i]) * local);
  }
  return z;
}

}  // namespace hybrid_quad
