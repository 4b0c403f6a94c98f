#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

namespace {

using Origin = PositivePart::Origin;

/// Where a surface has two sides so near to each other that moving vertices on to a plane would press them together.
class ThinPlaces {
 public:
  ThinPlaces(const TriangleMesh& mesh, int axis) : mesh_(mesh), axis_(axis) {}

  /// Whether a face that faces the other way, and does not meet v, is within some heights of v over the plane.
  bool is_thin_at(int v) {
    constexpr double kHeights = 10, kAlong = 0.5, kOpposed = -0.5;  // cosines
    const Vector3& p = mesh_.position(v);
    const double reach = kHeights * std::abs(p[axis_]);
    const auto is_opposed = [&](int f, const Vector3& normal) {
      const auto& t = mesh_.face(f);
      if (t[0] == v || t[1] == v || t[2] == v || index_->normal(f).dot(normal) > kOpposed) return false;
      return (nearest_on_triangle(p, mesh_.position(t[0]), mesh_.position(t[1]), mesh_.position(t[2])) - p).norm() < reach;
    };
    const int start = mesh_.outgoing(v);
    for (int h = start; h >= 0;) {
      const Vector3 normal = mesh_.normal(h / 3);
      // Moved along itself, a surface does not get thinner.
      if (std::abs(normal[axis_]) > kAlong) {
        if (!index_) index_ = std::make_unique<const SurfaceIndex>(mesh_, std::vector<int>{});
        const Vector3 half = Vector3::Constant(reach);
        if (index_->any_in_box(p - half, p + half, [&](int f) { return is_opposed(f, normal); })) return true;
      }
      h = mesh_.rotate_ccw(h);
      if (h == start) break;
    }
    return false;
  }

 private:
  const TriangleMesh& mesh_;
  int axis_;
  std::unique_ptr<const SurfaceIndex> index_;
};

/// Moves vertices on to the plane that are nearer to it than a small part of their shortest edge (or than rounding), so
/// that the cut makes no needles; not where that would press two sides of a thin surface together.
void snap_to_plane(const TriangleMesh& mesh, int axis, std::vector<Vector3>& positions) {
  constexpr double kPartOfEdge = 0.02, kRounding = 1e-7;  // of the diagonal
  const double rounding = kRounding * mesh.diagonal();
  std::vector<double> shortest(mesh.vertex_count(), std::numeric_limits<double>::infinity());
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    for (const int v : {mesh.from(h), mesh.to(h)}) shortest[v] = std::min(shortest[v], mesh.edge_length(h));
  ThinPlaces thin(mesh, axis);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double height = std::abs(positions[v][axis]);
    if (!std::isfinite(shortest[v]) || height > std::max(rounding, kPartOfEdge * shortest[v])) continue;
    if (height <= rounding || !thin.is_thin_at(v)) positions[v][axis] = 0.0;
  }
}

/// Clips a mesh at one plane.
class PlaneCut {
 public:
  /// \param is_first  no other plane cut the surface before
  PlaneCut(const TriangleMesh& mesh, int axis, bool is_first)
      : mesh_(mesh), axis_(axis), is_first_(is_first), positions_(mesh.positions()) {
    snap_to_plane(mesh, axis, positions_);
    for (int v = 0; v < mesh.vertex_count(); ++v) vertex_.push_back({{v, -1, -1}, {1, 0, 0}});
  }

  PositivePart run() {
    piece_.assign(mesh_.halfedge_count(), -1);
    middle_.assign(mesh_.halfedge_count(), -1);
    for (int f = 0; f < mesh_.face_count(); ++f) clip(f);
    for (int h = 0; h < mesh_.halfedge_count(); ++h) {
      const int o = mesh_.opposite(h);
      if (piece_[h] >= 0 && o >= 0) opposite_[piece_[h]] = piece_[o];
    }
    refuse_if_useless();
    split_fans();
    PositivePart part;
    part.mesh = TriangleMesh(std::move(positions_), std::move(faces_), std::move(opposite_));
    part.vertex = std::move(vertex_);
    part.halfedge = std::move(halfedge_);
    part.face = std::move(face_);
    part.faces_in_plane = in_plane_;
    return part;
  }

 private:
  double height(int v) const { return positions_[v][axis_]; }

  /// The vertex at which the edge of half-edge h meets the plane, one for both of its sides.
  int crossing(int h) {
    const int o = mesh_.opposite(h);
    if (middle_[h] >= 0) return middle_[h];
    const int e = o >= 0 ? std::min(h, o) : h;
    const int a = mesh_.from(e), b = mesh_.to(e);
    const double t = height(a) / (height(a) - height(b));
    Vector3 p = positions_[a] + t * (positions_[b] - positions_[a]);
    p[axis_] = 0.0;
    const int v = static_cast<int>(positions_.size());
    positions_.push_back(p);
    vertex_.push_back({{a, b, -1}, {1 - t, t, 0}});
    middle_[h] = v;
    if (o >= 0) middle_[o] = v;
    return v;
  }

  /// The positive part of a face: nothing, a triangle, or two.
  void clip(int f) {
    struct Corner {
      int vertex;
      int side;  ///< half-edge on which the side from here to the next corner lies, -1: on the cut
    };
    std::vector<Corner> corners;
    double highest = 0, lowest = 0;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int a = mesh_.from(h), b = mesh_.to(h);
      highest = std::max(highest, height(a));
      lowest = std::min(lowest, height(a));
      const bool leaves = height(a) > 0 && height(b) < 0, enters = height(a) < 0 && height(b) > 0;
      if (height(a) >= 0) corners.push_back({a, height(a) == 0 && height(b) < 0 ? -1 : h});
      if (leaves) corners.push_back({crossing(h), -1});
      if (enters) corners.push_back({crossing(h), h});
    }
    below_ |= lowest < 0;
    if (highest == 0) {
      in_plane_ += lowest == 0;
      return;
    }
    if (corners.size() == 3) {
      add_triangle(f, {corners[0].vertex, corners[1].vertex, corners[2].vertex},
                   {corners[0].side, corners[1].side, corners[2].side});
      return;
    }
    // Along the shorter diagonal.
    const auto gap = [&](int i) {
      return (positions_[corners[i + 2].vertex] - positions_[corners[i].vertex]).squaredNorm();
    };
    if (gap(1) < gap(0)) std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    const auto& c = corners;
    const int first = add_triangle(f, {c[0].vertex, c[1].vertex, c[2].vertex}, {c[0].side, c[1].side, -1});
    const int second = add_triangle(f, {c[0].vertex, c[2].vertex, c[3].vertex}, {-1, c[2].side, c[3].side});
    opposite_[3 * first + 2] = 3 * second;
    opposite_[3 * second] = 3 * first + 2;
  }

  int add_triangle(int f, const std::array<int, 3>& vertices, const std::array<int, 3>& sides) {
    const int id = static_cast<int>(faces_.size());
    faces_.push_back(vertices);
    face_.push_back(f);
    for (int i = 0; i < 3; ++i) {
      opposite_.push_back(-1);
      halfedge_.push_back(sides[i]);
      if (sides[i] >= 0) piece_[sides[i]] = 3 * id + i;
    }
    return id;
  }

  void refuse_if_useless() const {
    const std::string name = std::string(1, "xyz"[axis_]) + " = 0";
    if (faces_.empty())
      throw InputError("symmetry_side_empty", (is_first_ ? "Nothing of the surface is on the positive side of the mirror plane "
                                                         : "Nothing that other mirror planes leave is on the positive side of ") +
                                                  name + (in_plane_ > 0 ? "; faces in the plane are left out." : "."));
    bool reaches = below_;
    for (std::size_t h = 0; h < opposite_.size() && !reaches; ++h)
      reaches = opposite_[h] < 0 && height(faces_[h / 3][h % 3]) == 0 && height(faces_[h / 3][(h % 3 + 1) % 3]) == 0;
    if (!reaches)
      throw InputError("symmetry_plane_missed", "The whole surface is on one side of the mirror plane " + name +
                                                    " and has no edge on it; mirror planes go through the origin.");
  }

  /// Gives every fan of faces at a vertex a vertex of its own and drops vertices without faces.
  void split_fans() {
    std::vector<int> fan(opposite_.size(), -1);
    std::vector<Vector3> positions;
    std::vector<Origin> origins;
    for (int start = 0; start < static_cast<int>(fan.size()); ++start) {
      if (fan[start] >= 0) continue;
      const int v = static_cast<int>(positions.size()), old = faces_[start / 3][start % 3];
      positions.push_back(positions_[old]);
      origins.push_back(vertex_[old]);
      for (int h = start; h >= 0 && fan[h] < 0; h = opposite_[TriangleMesh::previous(h)]) fan[h] = v;
      for (int h = start; opposite_[h] >= 0;) {
        h = TriangleMesh::next(opposite_[h]);
        if (fan[h] >= 0) break;
        fan[h] = v;
      }
    }
    for (int h = 0; h < static_cast<int>(fan.size()); ++h) faces_[h / 3][h % 3] = fan[h];
    positions_ = std::move(positions);
    vertex_ = std::move(origins);
  }

  const TriangleMesh& mesh_;
  int axis_;
  bool is_first_;
  std::vector<Vector3> positions_;
  std::vector<Origin> vertex_;
  std::vector<std::array<int, 3>> faces_;
  std::vector<int> opposite_, halfedge_, face_;
  std::vector<int> piece_;   ///< 3 #F of the whole: the half-edge of the part that lies on it, -1
  std::vector<int> middle_;  ///< 3 #F of the whole: the vertex where it crosses the plane, -1
  int in_plane_ = 0;
  bool below_ = false;
};

/// What a vertex of a part's part is in the whole: all its sources lie in one face.
Origin composed(const Origin& origin, const std::vector<Origin>& first) {
  Origin out;
  int count = 0;
  for (int i = 0; i < 3 && origin.vertex[i] >= 0; ++i) {
    const Origin& source = first[origin.vertex[i]];
    for (int j = 0; j < 3 && source.vertex[j] >= 0; ++j) {
      const auto end = out.vertex.begin() + count;
      const auto at = std::find(out.vertex.begin(), end, source.vertex[j]);
      if (at == end) {
        if (count == 3) throw InternalError("symmetry", "a cut left its face");
        out.vertex[count++] = source.vertex[j];
      }
      out.weight[at - out.vertex.begin()] += origin.weight[i] * source.weight[j];
    }
  }
  return out;
}

PositivePart composed(PositivePart second, const PositivePart& first) {
  for (Origin& origin : second.vertex) origin = composed(origin, first.vertex);
  for (int& h : second.halfedge)
    if (h >= 0) h = first.halfedge[h];
  for (int& f : second.face) f = first.face[f];
  second.faces_in_plane += first.faces_in_plane;
  return second;
}

/// Images of an edge on the line in which two planes meet coincide, and four faces meet there.
void refuse_edges_in_two_planes(const TriangleMesh& mesh, PlaneSet planes) {
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h)) continue;
    const Vector3 &a = mesh.position(mesh.from(h)), &b = mesh.position(mesh.to(h));
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) count += has_plane(planes, axis) && a[axis] == 0 && b[axis] == 0;
    if (count > 1)
      throw InputError("symmetry_edge_in_two_planes", "The surface has an edge on the line in which two mirror planes meet: "
                                                      "its four mirror images would have that edge in common.");
  }
}

}  // namespace

PositivePart positive_part(const TriangleMesh& mesh, PlaneSet planes) {
  PositivePart part;
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    if (!has_plane(planes, axis)) continue;
    part = any ? composed(PlaneCut(part.mesh, axis, false).run(), part) : PlaneCut(mesh, axis, true).run();
    any = true;
  }
  if (!any) throw InternalError("symmetry", "no plane to cut at");
  refuse_edges_in_two_planes(part.mesh, planes);
  return part;
}

}  // namespace hybrid_quad
