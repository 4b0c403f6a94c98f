#include "hybrid_quad/singular_patches/node_chords.h"

#include <utility>

namespace hybrid_quad {

namespace {

/// Triangles with their gluing, open to change.
struct Triangles {
  std::vector<std::array<int, 3>> faces;
  std::vector<int> opposite, arc;

  void glue(int g, int h) {
    opposite[g] = h;
    if (h >= 0) opposite[h] = g;
  }

  /// Cuts face f in two from the middle `v` of its side h to its far corner. The half of side h nearer its
  /// origin stays where it is. \return the half-edge of the other half
  int cut(int h, int v) {
    const int f = h / 3, i = h % 3, j = (i + 1) % 3, k = (i + 2) % 3;
    const std::array<int, 3> old = faces[f];
    const int g = 3 * static_cast<int>(faces.size());  // new face (v, to, far)
    const int outer = opposite[3 * f + j], outer_arc = arc[3 * f + j];
    faces.push_back({v, old[j], old[k]});
    faces[f][j] = v;
    opposite.insert(opposite.end(), {-1, -1, -1});
    arc.insert(arc.end(), {-1, outer_arc, -1});
    glue(g + 1, outer);
    arc[3 * f + j] = -1;
    glue(g + 2, 3 * f + j);
    return g;
  }
};

}  // namespace

PatchSurface split_node_chords(const PatchSurface& patch) {
  const TriangleMesh& mesh = patch.mesh;
  const auto is_node = [&](int v) { return patch.node[v] >= 0 && mesh.is_boundary_vertex(v); };
  std::vector<int> chords;
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (h < mesh.opposite(h) && is_node(mesh.from(h)) && is_node(mesh.to(h)) &&
        (patch.morse[mesh.from(h)] < 0) == (patch.morse[mesh.to(h)] < 0))
      chords.push_back(h);
  if (chords.empty()) return patch;

  PatchSurface result;
  result.morse = patch.morse;
  result.node = patch.node;
  result.target_length = patch.target_length;
  std::vector<Vector3> positions = mesh.positions();
  Triangles t{mesh.faces(), mesh.opposites(), patch.boundary_arc};
  // A cut keeps the sides of its face under their numbers but for the one after the side it cuts: look chords
  // up by ends.
  std::vector<int> moved(mesh.halfedge_count());
  for (int h = 0; h < mesh.halfedge_count(); ++h) moved[h] = h;
  std::vector<int> home = moved;  // inverse, grows with the faces
  const auto cut = [&](int h, int v) {
    const int next = TriangleMesh::next(h), g = t.cut(h, v);
    home.resize(t.opposite.size(), -1);
    const int original = home[next];
    home[next] = -1;
    home[g + 1] = original;
    if (original >= 0) moved[original] = g + 1;
    return g;
  };
  for (const int chord : chords) {
    const int h = moved[chord], o = t.opposite[h];
    const int v = static_cast<int>(positions.size());
    positions.push_back(0.5 * (mesh.position(mesh.from(chord)) + mesh.position(mesh.to(chord))));
    result.morse.push_back(0);
    result.node.push_back(-1);
    const int far = cut(h, v), far_opposite = cut(o, v);
    t.glue(h, far_opposite);
    t.glue(o, far);
  }
  result.mesh = TriangleMesh(std::move(positions), std::move(t.faces), std::move(t.opposite));
  result.boundary_arc = std::move(t.arc);
  return result;
}

}  // namespace hybrid_quad
