#pragma once

#include <Eigen/SparseCore>

namespace hybrid_quad {

using SparseMatrix = Eigen::SparseMatrix<double>;

}  // namespace hybrid_quad
