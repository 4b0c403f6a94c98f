#pragma once

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/quad_complex.h"

namespace hybrid_quad {

/// Brings the number of quads near a wanted one by whole rows of quads: of the rows that are short enough, those of the
/// widest quads are split, or those of the narrowest are taken out. Regular vertices stay regular. No more than a third of the
/// quads are added or taken.
/// \param tolerance  of the number
/// \param counted  #curves, or empty: those whose number of edges stays
/// \return rows split and taken out
int fit_quad_count(QuadComplex& complex, double wanted, double tolerance, const std::vector<char>& counted,
                   const RunContext& context = {});

}  // namespace hybrid_quad
