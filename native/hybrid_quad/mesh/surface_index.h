#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// A point of a triangle mesh.
struct SurfacePoint {
  int face = -1;
  int boxes_opened = 0;  ///< by the search that found it: what that took
  Vector3 position = Vector3::Zero();
  double squared_distance = 0;
};

/// The most that a squared distance from p is with rounding. Of what differs by no more, the face that comes first counts
/// as the nearest, so that how a surface lies in space makes no difference.
inline double with_rounding(double squared_distance, const Vector3& p) {
  return squared_distance * (1 + 1e-12) + 1e-19 * p.squaredNorm();
}

/// Nearest points of a triangle mesh: a bounding-volume tree with an optional filter by region and by normal.
class SurfaceIndex {
 public:
  /// \param face_region  #F, may be empty (no filter by region)  \throws Cancelled
  SurfaceIndex(const TriangleMesh& mesh, std::vector<int> face_region, const RunContext& context = {});
  /// The index of the same surface without regions, which shares all that this one holds.
  SurfaceIndex without_regions() const;

  struct Filter {
    int region = -1;                       ///< only faces of this region; -1 = any
    Vector3 normal = Vector3::Zero();      ///< with min_cosine > -1: only faces whose normal agrees
    double min_cosine = -2;
    int hint = -1;                         ///< a face near the answer: a first bound by walking
    double within = std::numeric_limits<double>::infinity();  ///< only points nearer than this
    bool any = false;                      ///< the first face found will do: who asks whether there is one
  };
  /// The nearest point among faces that pass the filter; face = -1 if there is none.
  SurfacePoint nearest(const Vector3& p, const Filter& filter) const;
  SurfacePoint nearest(const Vector3& p) const { return nearest(p, Filter{}); }
  /// The nearest point found by walking from face `start` downhill over neighbours, never across a region's border.
  SurfacePoint walk(const Vector3& p, int start) const;

  /// Calls visit(face) for the faces that meet the box [low, high], and some others of which the bounding box does, until it returns true.
  bool any_in_box(const Vector3& low, const Vector3& high, const std::function<bool(int)>& visit) const;

  const TriangleMesh& mesh() const;
  const Vector3& normal(int face) const;  ///< of length 1

 private:
  struct Tree;
  bool passes(int face, const Filter& filter) const;
  const std::vector<int>& region() const;

  std::shared_ptr<const Tree> tree_;
  bool knows_regions_ = true;
};

/// The point of triangle (a, b, c) nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Vector3 nearest_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace hybrid_quad
