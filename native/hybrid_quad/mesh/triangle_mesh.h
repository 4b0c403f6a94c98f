#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// An oriented 2-manifold triangle mesh, possibly with boundary and several components; immutable once built.
///
/// Half-edge h = 3 f + i runs in face f from its corner i to its corner i + 1. `opposite[h]` is the half-edge of the
/// neighbouring face along the same edge, or -1 on the boundary. Identity of an edge is a half-edge, never a vertex pair,
/// so two faces may share more than one edge.
class TriangleMesh {
 public:
  TriangleMesh() = default;

  /// Pairs half-edges by their vertices.
  /// \pre every directed edge (a, b) appears at most once and every vertex has one fan; use build_mesh() for raw input
  /// \throws InternalError if a directed edge appears twice or a vertex has more than one fan
  TriangleMesh(std::vector<Vector3> positions, std::vector<std::array<int, 3>> faces);

  /// Takes the gluing as given (edges that vertex pairs cannot tell apart).
  TriangleMesh(std::vector<Vector3> positions, std::vector<std::array<int, 3>> faces, std::vector<int> opposite);

  /// The same faces, joined alike. \pre a position for each vertex
  TriangleMesh with_positions(std::vector<Vector3> positions) &&;

  int vertex_count() const { return static_cast<int>(positions_.size()); }
  int face_count() const { return static_cast<int>(faces_.size()); }
  int halfedge_count() const { return 3 * face_count(); }

  const std::vector<Vector3>& positions() const { return positions_; }
  const Vector3& position(int v) const { return positions_[v]; }
  const std::vector<std::array<int, 3>>& faces() const { return faces_; }
  const std::array<int, 3>& face(int f) const { return faces_[f]; }
  const std::vector<int>& opposites() const { return opposite_; }
  int opposite(int h) const { return opposite_[h]; }

  static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
  static int face_of(int h) { return h / 3; }
  int from(int h) const { return faces_[h / 3][h % 3]; }
  int to(int h) const { return faces_[h / 3][(h % 3 + 1) % 3]; }
  bool is_boundary(int h) const { return opposite_[h] < 0; }
  bool is_boundary_vertex(int v) const { return boundary_[v] != 0; }

  /// One outgoing half-edge of v (-1 for an isolated vertex): on the boundary the first of the fan in counterclockwise
  /// order, that is, the one whose own edge is on the boundary.
  int outgoing(int v) const { return outgoing_[v]; }
  /// The next outgoing half-edge counterclockwise around its origin, or -1 past the last of a boundary fan.
  int rotate_ccw(int h) const { return opposite_[previous(h)]; }
  /// The next outgoing half-edge clockwise around its origin, or -1 past the first of a boundary fan.
  int rotate_cw(int h) const { return opposite_[h] < 0 ? -1 : next(opposite_[h]); }
  /// Calls visit(h) for a half-edge of every edge at v, h leaving v except for the last one of a boundary fan.
  template <class Visit>
  void visit_edges_at(int v, Visit&& visit) const {
    const int start = outgoing(v);
    for (int h = start; h >= 0;) {
      visit(h);
      if (is_boundary(previous(h))) {
        visit(previous(h));
        return;
      }
      h = rotate_ccw(h);
      if (h == start) return;
    }
  }
  /// The other end of h's edge. \pre v is one of its ends
  int other_end(int h, int v) const { return from(h) == v ? to(h) : from(h); }

  Vector3 edge_vector(int h) const { return positions_[to(h)] - positions_[from(h)]; }
  double edge_length(int h) const { return edge_vector(h).norm(); }
  /// Twice the area times the unit normal.
  Vector3 area_normal(int f) const {
    const auto& t = faces_[f];
    return (positions_[t[1]] - positions_[t[0]]).cross(positions_[t[2]] - positions_[t[0]]);
  }
  /// Unit; (0, 0, 1) for a face without area.
  Vector3 normal(int f) const {
    const Vector3 n = area_normal(f);
    const double length = n.norm();
    return length > 0 ? Vector3(n / length) : Vector3(0, 0, 1);
  }
  double area(int f) const { return 0.5 * area_normal(f).norm(); }
  double total_area() const;
  double mean_edge_length() const;
  /// Length of the bounding box's diagonal.
  double diagonal() const;
  /// Twice the distance of the vertex farthest from the middle of the surface: of a box its diagonal, and the same however a mesh is turned.
  double extent() const;
  /// V - E + F, isolated vertices not counted.
  int euler_characteristic() const;

 private:
  void index_vertices();
  std::vector<Vector3> positions_;
  std::vector<std::array<int, 3>> faces_;
  std::vector<int> opposite_;
  std::vector<int> outgoing_;
  std::vector<char> boundary_;
};

}  // namespace hybrid_quad
