#pragma once

#include "hybrid_quad/mesh/polychords.h"

namespace hybrid_quad {

/// Takes a polychord out: the quads that it crosses go, and the two ends of every side that it crosses become one vertex,
/// where what is bound to a curve or corner stays, else in the middle.
/// \param id  of the polychord
/// \return false, and nothing changed, where the strip touches itself, where two different curves or corners would meet, or
/// where what comes of it is no indexed mesh: a curve without edges, a doublet, a double edge, a border of three edges; or where more quads
/// would lie alone between two features
bool collapse_polychord(QuadComplex& complex, const Polychords& polychords, int id);

}  // namespace hybrid_quad
