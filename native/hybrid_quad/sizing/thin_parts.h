#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// A vertex on a tube or a tip so thin that fewer than four quads of the asked length would go around it.
struct ThinPlace {
  int vertex;
  double length;  ///< of four quads around (scene units)
};

/// All such places, by vertex (docs/decisions/0005). Wide thin sheets are none. Thickness is the diameter of the largest ball inside that
/// touches the surface at a vertex (shrinking ball of Ma et al. 2012), measured at about four vertices a quad.
/// \param length  asked quad edge length (scene units)
std::vector<ThinPlace> thin_places(const SurfaceIndex& index, double length, const RunContext& context);

}  // namespace hybrid_quad
