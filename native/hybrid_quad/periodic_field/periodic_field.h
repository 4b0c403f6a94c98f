#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hybrid_quad/frame_field/frame_field.h"
#include "hybrid_quad/grid_algebra/quarter_turn.h"

namespace hybrid_quad {

/// What a vertex's Psi is bound to.
enum class GridConstraint : std::uint8_t {
  kFree,
  kIsolineV,  ///< v integer in the vertex gauge: b = a (a feature runs along u)
  kIsolineU,  ///< u integer in the vertex gauge: b = conj a
  kCorner,    ///< both: a = b = +-1
};

/// Psi of the paper at every vertex, in a complex basis (quarter_turn.h).
struct PeriodicField {
  std::vector<PhasePair> psi;              ///< #V, in the vertex's gauge; |a| = |b| = 1, constraints exact
  std::vector<std::uint8_t> corner_turn;   ///< 3 #F: value in the face = turned(psi[v], corner_turn[3 f + i])
  std::vector<GridConstraint> constraint;  ///< #V
  double energy = 0;  ///< weighted mean of squared edge discrepancies (Eq. 16 over W_sum)
};

enum class PeriodicSolver { kMultilevel, kEigenGaussNewton };

struct PeriodicFieldOptions {
  PeriodicSolver solver = PeriodicSolver::kMultilevel;
  double feature_weight = 20;        ///< mu, paper 3.2
  double constraint_weight = 1;      ///< w_r, Eq. (18)
  double gradient_tolerance = 1e-3;  ///< stop of Gauss-Newton (relative)
  int max_newton_steps = 30;
  int strip_rows = 1;  ///< rows of quads that a narrow strip between two features gets room for
  int sweeps = 10;     ///< nonlinear relaxation sweeps a level
  int coarsest = 300;  ///< nodes of the level whose eigenvector starts the multilevel solve
};

/// Minimises the Dirichlet energy of Psi under the feature constraints (paper 2.6, 3.2, 3.3).
PeriodicField solve_periodic_field(const WorkingSurface& surface, const FrameField& frames,
                                   const PeriodicFieldOptions& options, const RunContext& context);

std::vector<std::string> violations_of(const PeriodicField& field, const WorkingSurface& surface,
                                       const FrameField& frames);

}  // namespace hybrid_quad
