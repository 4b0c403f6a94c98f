#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Normals that tell creases from folds between slivers (docs/decisions/0055). What rises less than `rise` above what it goes on in, and is
/// folded along a quarter of its border and more, tells nothing of how the surface lies there, be it the rounding of a file's coordinates or
/// the wall of a low step: it takes the normals of what is beside its longest and least bent border.
/// \param normals     #F, unit
/// \param is_inner    3 #F: edges that are looked at, both sides alike; others part facets however they bend
/// \param bend, fold  radians: edges that bend by more part facets, those that bend by still more are folds
/// \param rise        scene units: of a facet, twice its area over the length of its border, which is the width of a strip, times the mean sine
///                    of its folds
/// \return #F; facets that meet only others like them keep theirs
std::vector<Vector3> normals_beside_narrow_facets(const TriangleMesh& mesh, const std::vector<Vector3>& normals,
                                                  const std::vector<char>& is_inner, double bend, double fold, double rise);

}  // namespace hybrid_quad
