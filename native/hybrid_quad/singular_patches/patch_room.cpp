#include "hybrid_quad/singular_patches/patch_room.h"

namespace hybrid_quad {

namespace {

double area_of_piece(const GridOverlay& overlay, int piece) {
  const auto position = [&](int k) -> const Vector3& { return overlay.vertices[overlay.origin[k]].position; };
  const int begin = overlay.piece_begin[piece], end = overlay.piece_begin[piece + 1];
  Vector3 sum = Vector3::Zero();
  for (int k = begin + 1; k + 1 < end; ++k) sum += 0.5 * (position(k) - position(begin)).cross(position(k + 1) - position(begin));
  return sum.norm();
}

}  // namespace

double quads_by_area(const WorkingSurface& surface, const GridOverlay& overlay, const std::vector<int>& pieces) {
  double sum = 0;
  for (const int piece : pieces) {
    const double length = surface.target_length[overlay.piece_face[piece]];
    sum += area_of_piece(overlay, piece) / (length * length);
  }
  return sum;
}

}  // namespace hybrid_quad
