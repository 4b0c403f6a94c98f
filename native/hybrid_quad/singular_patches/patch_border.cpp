#include "hybrid_quad/singular_patches/patch_border.h"

#include <algorithm>

namespace hybrid_quad {

PatchBorder border_of(const PatchSurface& patch) {
  const TriangleMesh& mesh = patch.mesh;
  PatchBorder loops;
  std::vector<char> seen(mesh.halfedge_count(), 0);
  std::vector<int> ids;
  for (int seed = 0; seed < mesh.halfedge_count(); ++seed) {
    // A loop is entered at a node, so that no arc is cut in two.
    if (!mesh.is_boundary(seed) || seen[seed] || patch.node[mesh.from(seed)] < 0) continue;
    std::vector<PatchArc> loop;
    for (int h = seed; !seen[h]; h = mesh.outgoing(mesh.to(h))) {
      seen[h] = 1;
      if (patch.node[mesh.from(h)] >= 0) {
        loop.emplace_back();
        loop.back().id = patch.boundary_arc[h];
        loop.back().from = mesh.from(h);
        ids.push_back(loop.back().id);
      }
      PatchArc& arc = loop.back();
      arc.halfedges.push_back(h);
      arc.to = mesh.to(h);
      if (patch.boundary_arc[h] != arc.id || arc.id < 0)
        throw InternalError("patch", "an arc changes its id between two nodes");
    }
    for (PatchArc& arc : loop) {
      arc.rising = patch.morse[arc.from] < patch.morse[arc.to];
      if ((patch.morse[arc.from] < 0) == (patch.morse[arc.to] < 0))
        throw InternalError("patch",
                            "arc " + std::to_string(arc.id) + " does not join a minimum and a maximum");
    }
    if (loop.size() < 4 || loop.size() % 2 != 0)
      throw InternalError("patch", "a border loop has " + std::to_string(loop.size()) + " arcs");
    loops.push_back(std::move(loop));
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.is_boundary(h) && !seen[h]) throw InternalError("patch", "a border loop has no node");
  std::sort(ids.begin(), ids.end());
  if (std::adjacent_find(ids.begin(), ids.end()) != ids.end())
    throw InternalError("patch", "two arcs have the same id");
  return loops;
}

}  // namespace hybrid_quad
