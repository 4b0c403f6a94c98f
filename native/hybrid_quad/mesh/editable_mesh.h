#pragma once

#include <vector>

#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// A triangle mesh under local operations. Half-edges as in TriangleMesh; faces and vertices that are gone keep their ids
/// until `compacted`. Every half-edge carries a curve (-1 = none), every face a region, which the operations hand on.
class EditableMesh {
 public:
  explicit EditableMesh(const TriangleMesh& mesh, std::vector<int> halfedge_curve = {}, std::vector<int> face_region = {});

  int face_slots() const { return static_cast<int>(region_.size()); }
  int halfedge_slots() const { return 3 * face_slots(); }
  int vertex_slots() const { return static_cast<int>(positions_.size()); }
  bool is_face(int f) const { return origin_[3 * f] >= 0; }
  bool is_vertex(int v) const { return outgoing_[v] >= 0; }

  static int next(int h) { return TriangleMesh::next(h); }
  static int previous(int h) { return TriangleMesh::previous(h); }
  int from(int h) const { return origin_[h]; }
  int to(int h) const { return origin_[next(h)]; }
  int apex(int h) const { return origin_[previous(h)]; }
  int opposite(int h) const { return opposite_[h]; }
  int curve(int h) const { return curve_[h]; }
  int region(int f) const { return region_[f]; }
  int outgoing(int v) const { return outgoing_[v]; }
  bool is_boundary_vertex(int v) const { return opposite_[outgoing_[v]] < 0; }
  int rotate_ccw(int h) const { return opposite_[previous(h)]; }

  const Vector3& position(int v) const { return positions_[v]; }
  void set_position(int v, const Vector3& p) { positions_[v] = p; }
  Vector3 edge_vector(int h) const { return positions_[to(h)] - positions_[from(h)]; }
  Vector3 area_normal(int f) const {
    return (positions_[origin_[3 * f + 1]] - positions_[origin_[3 * f]])
        .cross(positions_[origin_[3 * f + 2]] - positions_[origin_[3 * f]]);
  }

  /// Splits the edge of h at p; h then ends at the new vertex, whose id is returned.
  int split_edge(int h, const Vector3& p);
  /// The edge between the two other corners would not join neighbours, and neither end is left with too few faces.
  bool can_flip(int h) const;
  void flip_edge(int h);
  /// Link condition for moving from(h) into to(h).
  bool can_collapse(int h) const;
  /// Merges from(h) into to(h). \pre can_collapse(h)
  void collapse(int h);
  /// Whether the surface stays a manifold of the same topology without this face at its boundary.
  bool can_take_away(int f) const;
  /// Takes a face at the boundary away, whose other sides then are boundary. \pre can_take_away(f)
  void take_away(int f);

  /// Calls visit(h) for each half-edge that leaves v, counterclockwise.
  template <class Visit>
  void visit_outgoing(int v, Visit&& visit) const {
    const int start = outgoing_[v];
    int h = start;
    do {
      visit(h);
      h = rotate_ccw(h);
    } while (h >= 0 && h != start);
  }
  bool are_neighbours(int v, int w) const;

  struct Compacted {
    TriangleMesh mesh;
    std::vector<int> halfedge_curve, face_region;
    std::vector<int> vertex_slot, face_slot;  ///< where each vertex and face of `mesh` was
  };
  Compacted compacted() const;
  /// The same, numbered by a breadth-first search over the faces: what is near on the surface is near in memory.
  Compacted compacted_by_neighbourhood() const;

 private:
  Compacted compacted_in_order(std::vector<int> vertex_slots, std::vector<int> face_slots) const;
  std::vector<int> faces_by_neighbourhood() const;
  void glue(int h, int o, int curve);
  void update_outgoing(int h, bool may_open = false);
  bool has_more_faces(int v, int count) const;

  std::vector<Vector3> positions_;
  std::vector<int> origin_, opposite_, curve_, region_, outgoing_;
};

}  // namespace hybrid_quad
