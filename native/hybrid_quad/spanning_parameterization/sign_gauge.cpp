#include "hybrid_quad/spanning_parameterization/sign_gauge.h"

#include <utility>

namespace hybrid_quad {

namespace {

/// The sign that Psi has to take at every vertex, or nothing.
std::vector<signed char> vertex_signs(const TriangleMesh& mesh, const LiftedGrid& grid) {
  std::vector<signed char> sign(mesh.vertex_count(), 0);
  std::vector<int> front;
  for (int start = 0; start < mesh.vertex_count(); ++start) {
    if (sign[start] != 0 || mesh.outgoing(start) < 0) continue;
    sign[start] = 1;
    front.push_back(start);
    while (!front.empty()) {
      const int p = front.back();
      front.pop_back();
      const auto visit = [&](int q, int h) {
        const auto wanted = static_cast<signed char>(is_odd(grid.jump[h]) ? -sign[p] : sign[p]);
        if (sign[q] == 0) {
          sign[q] = wanted;
          front.push_back(q);
        }
        return sign[q] == wanted;
      };
      const int first = mesh.outgoing(p);
      for (int h = first;;) {
        const int incoming = TriangleMesh::previous(h);
        if (!visit(mesh.to(h), h) || !visit(mesh.from(incoming), incoming)) return {};
        h = mesh.rotate_ccw(h);
        if (h < 0 || h == first) break;
      }
    }
  }
  return sign;
}

}  // namespace

bool can_make_jumps_even(const TriangleMesh& mesh, const LiftedGrid& grid) {
  return mesh.vertex_count() == 0 || !vertex_signs(mesh, grid).empty();
}

bool make_jumps_even(const TriangleMesh& mesh, LiftedGrid& grid) {
  const std::vector<signed char> sign = vertex_signs(mesh, grid);
  if (sign.empty()) return mesh.vertex_count() == 0;
  constexpr IntVector2 kShift{1, 0};
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    for (const auto& [corner, direction] : {std::pair{h, 1}, std::pair{TriangleMesh::next(h), -1}}) {
      if (sign[mesh.from(corner)] > 0) continue;
      const IntVector2 there = turned(kShift, grid.corner_turn[corner]);
      grid.jump[h] = {grid.jump[h][0] + direction * there[0], grid.jump[h][1] + direction * there[1]};
    }
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (sign[v] < 0) grid.value[v] += Vector2(kShift[0], kShift[1]);
  return true;
}

}  // namespace hybrid_quad
