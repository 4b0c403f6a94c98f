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

/// Thin places and how much of a surface they are.
struct ThinTubes {
  std::vector<ThinPlace> places;
  double share = 0;  ///< of the vertices looked at
};

/// As thin_places(), and where tubes have few sides, whose balls touch sides next to the one behind (docs/decisions/0053).
/// \param length  asked quad edge length (scene units)
ThinTubes thin_tubes(const SurfaceIndex& index, double length, const RunContext& context);

/// Whether nearly all of a surface is such tubes.
bool is_wire(const ThinTubes& tubes);
/// The same, by few of its vertices. \param length  asked quad edge length (scene units)
bool is_wire(const SurfaceIndex& index, double length, const RunContext& context);

}  // namespace hybrid_quad
