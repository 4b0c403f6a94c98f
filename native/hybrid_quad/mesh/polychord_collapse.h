#pragma once

#include "hybrid_quad/mesh/polychords.h"

namespace hybrid_quad {

/// Takes polychords out: the quads that they cross go, and the two ends of every side that they cross become one vertex,
/// where what is bound to a curve or corner stays, else in the middle.
/// \param chosen  by polychord: whether to take it out. Several have to be apart: no quad crossed by two, no vertex at the sides of two
/// \return false, and nothing changed, where a strip touches itself or another, where two different curves or corners would meet, or
/// where what comes of it is no indexed mesh: a curve without edges, a doublet, a double edge, a border of three edges; or where more quads
/// would lie alone between two features
bool collapse_polychords(QuadComplex& complex, const Polychords& polychords, const std::vector<char>& chosen);

}  // namespace hybrid_quad
