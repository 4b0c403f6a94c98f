#pragma once

#include <complex>
#include <vector>

#include "hybrid_quad/base/run_context.h"

namespace hybrid_quad {

using Complex = std::complex<double>;

/// Wants z[to] = (weight / |weight|) z[from], with stiffness |weight|.
struct CrossLink {
  int from, to;  ///< from < to
  Complex weight;
};

/// Unit complex numbers on the nodes of a graph with a unitary connection: minimise
///   sum over links |w| |z_to - (w / |w|) z_from|^2  +  what fixed neighbours pull (`source`, counted in `diagonal`).
struct CrossSystem {
  std::vector<CrossLink> links;
  std::vector<double> diagonal;
  std::vector<Complex> source;
  int size() const { return static_cast<int>(diagonal.size()); }
};

struct CrossRelaxation {
  int sweeps = 10;     ///< nonlinear Gauss-Seidel sweeps a level
  int coarsest = 300;  ///< nodes of the level that is solved directly
};

/// Multilevel minimiser. Nodes are aggregated in pairs, in the gauge of the pair's first node, so a coarse node stands
/// for a parallel field over its aggregate; the coarsest level is solved as a linear system (or for the lowest
/// eigenvector when nothing pulls), and on the way up every level is relaxed with |z| = 1. Near-linear time.
std::vector<Complex> relax_cross_system(const CrossSystem& system, const CrossRelaxation& options, const RunContext& context);

/// One step of diffusion over a time 1 / mass and renormalisation to |z| = 1 (MBO). Nodes whose value vanishes keep the
/// one they had. \param mass per node, > 0, in the units of `diagonal`
void diffuse_cross_system(const CrossSystem& system, const std::vector<double>& mass, std::vector<Complex>& z,
                          const RunContext& context);

}  // namespace hybrid_quad
