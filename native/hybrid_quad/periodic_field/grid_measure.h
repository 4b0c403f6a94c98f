#pragma once

#include <cstdint>
#include <vector>

#include "hybrid_quad/frame_field/frame_field.h"
#include "hybrid_quad/grid_algebra/quarter_turn.h"

namespace hybrid_quad {

/// How many quads every half-edge measures, and which grid direction the features follow.
struct GridMeasure {
  std::vector<Vector2> along;  ///< 3 #F, (du, dv) in the gauge of the half-edge's face
  std::vector<std::int8_t>
      axis;  ///< 3 #F: 0 a feature along u, 1 a feature along v (face gauge), -1 no feature

  /// The two sides' measures averaged, in the gauge of h's face.
  Vector2 average(const TriangleMesh& mesh, const FrameField& frames, int h) const {
    const int o = mesh.opposite(h);
    if (o < 0) return along[h];
    return 0.5 * (along[h] - turned(along[o], frames.matching[o]));
  }
};

/// Measures the frames along edges. Feature edges are laid on the nearer of the two grid directions: nothing
/// across, their whole length along, equal on both sides. Strips between two features get room for
/// `strip_rows` quads, and curves too short to get the edges that a quad mesh needs (one between two corners, four around a
/// loop) are stretched to that many, as are curves that are to get a certain number.
GridMeasure measure_edges(const WorkingSurface& surface, const FrameField& frames, int strip_rows = 1);

/// The vertex gauges: a vertex's values are those of the face of its outgoing(v); corner_turn takes them into
/// the others.
struct VertexGauges {
  std::vector<std::uint8_t>
      corner_turn;  ///< 3 #F: value in the face = turned(value at the vertex, corner_turn[3 f + i])
  std::vector<std::uint8_t>
      holonomy;  ///< #V: turn of one counterclockwise trip around the vertex; 0 on the boundary
};

VertexGauges choose_vertex_gauges(const TriangleMesh& mesh, const FrameField& frames);

}  // namespace hybrid_quad
