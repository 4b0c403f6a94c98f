#pragma once

#include "hybrid_quad/mesh/quad_complex.h"

namespace hybrid_quad::test {

/// The surface of a box with n x m x k quads along its sides.
QuadComplex quad_box(int n, int m, int k);
/// n x m quads in the plane.
QuadComplex quad_grid(int n, int m);
/// An open tube: n quads around, m along; its gluing is given, so n = 1 and n = 2 are possible.
QuadComplex quad_tube(int n, int m);
/// A torus of n x m quads; its gluing is given, so any n, m >= 1 are possible. \param shift  by how many of
/// the n quads the last of the m rows is turned against the first
QuadComplex quad_torus(int n, int m, int shift = 0);
/// n x n quads with two neighbouring sides glued: a disk around a vertex of one quad.
QuadComplex quad_cone(int n);
/// Two quads glued along their four sides: a sphere.
QuadComplex pillow();

/// Border loops as numbers of darts.
std::vector<int> border_loop_lengths(const QuadComplex& complex);

}  // namespace hybrid_quad::test
