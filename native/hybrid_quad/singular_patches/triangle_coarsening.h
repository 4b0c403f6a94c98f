#pragma once

#include <algorithm>
#include <vector>

#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/singular_patches/patch_border.h"

namespace hybrid_quad {

/// Triangles glued by half-edge (3 f + i), vertices by number; two vertices may be joined by several edges.
/// Kept by every operation: no edge is a loop, inner vertices keep three faces or more, border edges and
/// vertices stay.
class CoarseTriangles {
 public:
  /// The patch's triangles inside a collar: a strip of triangles along every border loop whose outer border
  /// has every other node (all maxima, or all minima) as its only vertices. So the border is right from the
  /// start and all vertices of the patch are free. Of the two, the nodes passed over are those that reach
  /// less into the patch.
  CoarseTriangles(const PatchSurface& patch, const PatchBorder& border);

  /// Collapses edges shorter than `length`, shortest first. \param keep_shape  only where no face turns away
  /// from the surface; without it, crumpled surfaces get coarse too
  void coarsen(double length, bool keep_shape, const RunContext& context);
  /// Flips edges towards six faces at every vertex.
  void flip_towards_six();
  /// Moves inner vertices to the mean of their neighbours, on the surface, where no face turns over.
  void smooth(const SurfaceIndex& surface, int sweeps);
  /// Gives inner vertices with fewer than three faces more of them.
  void raise_low_valences();
  /// Drops what is gone; face_count() counts it before.
  void compact();

  int alive_count() const { return static_cast<int>(std::count(alive_.begin(), alive_.end(), 1)); }
  int face_count() const { return static_cast<int>(vertex_.size()) / 3; }
  int from(int h) const { return vertex_[h]; }
  int to(int h) const { return vertex_[TriangleMesh::next(h)]; }
  int opposite(int h) const { return opposite_[h]; }
  /// The node that border half-edge h passes over: index into passed_nodes(), -1 inside.
  int passed_node(int h) const { return passed_[h]; }
  const std::vector<Vector3>& positions() const { return positions_; }

  /// What a border edge stands for: two arcs with a node between.
  struct PassedNode {
    int vertex;  ///< of the patch mesh
    int arc_before, arc_after;
  };
  const std::vector<PassedNode>& passed_nodes() const { return passed_nodes_; }
  /// The patch vertex that a border vertex is, -1 for inner ones.
  int border_vertex(int v) const { return border_vertex_[v]; }

 private:
  void add_collar(const PatchSurface& patch, const std::vector<PatchArc>& loop);
  int add_face(int a, int b, int c);
  void glue(int g, int h);
  bool on_border(int v) const { return border_vertex_[v] >= 0; }
  double edge_length(int h) const { return (positions_[to(h)] - positions_[from(h)]).norm(); }
  /// Outgoing half-edges of an inner vertex, counterclockwise from h.
  void fan(int h, std::vector<int>& out) const;
  /// Whether a face lies the way the surface does at its corners; faces with hardly any area (collars) may
  /// lie any way.
  bool faces_outwards(const std::array<int, 3>& corners, const std::array<Vector3, 3>& positions) const;
  bool can_collapse(int h);
  bool keeps_shape(int h, double longest);
  void collapse(int h, std::vector<int>& touched);
  bool can_flip(int h) const;
  void flip(int h);

  std::vector<int> vertex_, opposite_, passed_;
  std::vector<char> alive_;         // #F
  std::vector<int> faces_at_;       // #V
  std::vector<int> border_vertex_;  // #V
  std::vector<Vector3> positions_;
  std::vector<Vector3> normals_;  // #V: of the surface
  std::vector<PassedNode> passed_nodes_;
  std::vector<int> fan_;
};

}  // namespace hybrid_quad
