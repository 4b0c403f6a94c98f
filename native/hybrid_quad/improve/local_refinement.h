#pragma once

#include <vector>

#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Splits the sides that lie between two of some quads, or between one and the boundary, in three, and what is inside these quads
/// accordingly: nine quads where all four sides are split, else as many as fit. New vertices on feature curves are put on
/// these, others on the region of the surface that they are in. Everything else stays where it is, and so does the topology.
/// \param piece  of `mesh`, located (Workpiece::locate_all)
/// \param chosen  #Q
/// \param touched  gets the vertices of the quads that changed
QuadMesh refine_locally(const QuadMesh& mesh, const Workpiece& piece, const std::vector<char>& chosen, std::vector<int>* touched);

}  // namespace hybrid_quad
