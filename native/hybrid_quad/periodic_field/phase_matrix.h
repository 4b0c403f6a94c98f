#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "hybrid_quad/periodic_field/phase_graph.h"

namespace hybrid_quad {

/// The form of a PhaseGraph as a real symmetric matrix, its constraints eliminated: a free node
/// has four unknowns (Re a, Im a, Re b, Im b), one on an isoline two, a corner one, each along an orthonormal
/// direction of the constraint's space. E = 1/2 y^T H y.
struct PhaseMatrix {
  Eigen::SparseMatrix<double> lower;  ///< lower triangle of H
  std::vector<int> offset;            ///< #nodes + 1: first unknown of a node
};

PhaseMatrix assemble_phase_matrix(const PhaseGraph& graph);

/// Orthonormal columns that span what the constraint allows, and how many there are.
Eigen::Matrix4d constraint_basis(GridConstraint constraint);
int constraint_dimension(GridConstraint constraint);

Eigen::VectorXd unknowns_of(const PhaseGraph& graph, const PhaseMatrix& matrix,
                            const std::vector<PhasePair>& z);
std::vector<PhasePair> phases_of(const PhaseGraph& graph, const PhaseMatrix& matrix,
                                 const Eigen::VectorXd& y);

}  // namespace hybrid_quad
