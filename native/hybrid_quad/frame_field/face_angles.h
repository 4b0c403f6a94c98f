#pragma once

#include <utility>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// An orthonormal basis of a face's plane: `along` points from corner 0 to corner 1, `across` is the normal turned on it.
struct FaceBasis {
  Vector3 along, across, normal;
};

/// The basis of face f; some orthonormal basis where the face has no area.
FaceBasis face_basis(const TriangleMesh& mesh, int f);

/// The intrinsic geometry of a mesh as angles. The three corners of a face sum to pi to the last bits whatever its
/// shape, so index sums come out right on slivers and on faces without area too.
class FaceAngles {
 public:
  explicit FaceAngles(const TriangleMesh& mesh, const RunContext& context = {});

  /// Interior angle at the origin of half-edge h.
  double corner(int h) const { return corner_[h]; }
  /// Direction of half-edge h in its face, counterclockwise from the face's half-edge 0.
  double direction(int h) const { return direction_[h]; }
  /// What to add to a direction of h's face to have it in the opposite face (Levi-Civita). \pre h is interior
  double transport(int h, int opposite) const;

  /// By how much frames are expected to turn beyond that as they cross h: quarters are counted from there. \pre h is interior
  double expected_turn(int h) const { return expected_turn_.empty() ? 0 : expected_turn_[h]; }
  /// \param turns  3 #F, opposite for opposite half-edges
  void expect_turns(std::vector<double> turns) { expected_turn_ = std::move(turns); }

 private:
  std::vector<double> corner_, direction_, expected_turn_;
};

}  // namespace hybrid_quad
