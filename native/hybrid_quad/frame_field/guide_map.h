#pragma once

#include <complex>
#include <vector>

#include "hybrid_quad/frame_field/face_angles.h"

namespace hybrid_quad {

/// Directions asked for on a mesh, as crosses with a strength: a vector, turned by any number of quarters, is the same.
class GuideMap {
 public:
  GuideMap() = default;
  /// \param corner_guides  3 #F, at the corners of the triangles; zero: free; the length is the strength, more than 1
  /// counts as 1. What stands on the surface counts for its part along it.
  GuideMap(const TriangleMesh& mesh, const std::vector<Vector3>& corner_guides);

  bool empty() const { return corner_.empty(); }
  /// In the plane of face f near its point p, blended between the corners; the length is the strength, 0..1.
  Vector3 at(int f, const Vector3& p) const;

 private:
  const TriangleMesh* mesh_ = nullptr;
  std::vector<std::complex<double>> corner_;  ///< strength e^{4 i angle}, the angle from the face's basis
};

/// Weights of a triangle's corners at its point nearest to p in its plane, each within 0..1.
std::array<double, 3> corner_weights_at(const TriangleMesh& mesh, int f, const Vector3& p);

}  // namespace hybrid_quad
