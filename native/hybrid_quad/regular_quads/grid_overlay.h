#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hybrid_quad/regular_quads/curve_coordinates.h"

namespace hybrid_quad {

/// The surface cut along the integer lines of its parameterization: every regular face becomes convex pieces, each
/// inside one cell of the grid; faces that are not regular stay whole but share the cut points of their neighbours.
/// All decisions are made in integers, so pieces of neighbouring faces fit together exactly.
///
/// Half-edge k runs from overlay vertex `origin[k]` to the origin of the next half-edge of its piece.
struct GridOverlay {
  struct Vertex {
    Vector3 position = Vector3::Zero();
    int surface_vertex = -1;    ///< the working surface's vertex it is, or -1
    std::int8_t grid_sign = 0;  ///< +1 / -1 at grid points (Morse maxima / minima), 0 elsewhere
  };
  std::vector<Vertex> vertices;
  std::vector<int> piece_begin;      ///< #pieces + 1: first half-edge of each piece
  std::vector<int> piece_face;       ///< #pieces: face of the working surface
  std::vector<char> piece_regular;   ///< #pieces: inside one cell of the grid
  std::vector<int> origin;           ///< per half-edge
  std::vector<int> opposite;         ///< per half-edge, -1 on the surface's boundary
  std::vector<int> piece_of;         ///< per half-edge
  std::vector<char> on_isoline;      ///< per half-edge: along an integer line of a regular face, or on a feature
  std::vector<int> curve;            ///< per half-edge: feature curve or -1
  std::vector<Vector2> uv;           ///< per half-edge: its origin in the face's chart, in quads
  std::vector<int> surface_halfedge; ///< per half-edge: the half-edge of the working surface it is part of, or -1

  int piece_count() const { return static_cast<int>(piece_face.size()); }
  int next(int k) const { return k + 1 < piece_begin[piece_of[k] + 1] ? k + 1 : piece_begin[piece_of[k]]; }
  int previous(int k) const { return k > piece_begin[piece_of[k]] ? k - 1 : piece_begin[piece_of[k] + 1] - 1; }
  int target(int k) const { return origin[next(k)]; }
};

GridOverlay build_grid_overlay(const WorkingSurface& surface, const SpanningParameterization& param,
                               const CurveCoordinates& curves, const RunContext& context);

}  // namespace hybrid_quad
