#pragma once

#include <vector>

#include "hybrid_quad/frame_field/guide_map.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// The guides at a workpiece's vertices, known again while a vertex stays: each neighbour that moves asks for them.
class VertexGuides {
 public:
  /// \param guides  on the input, may be null
  VertexGuides(const Workpiece& piece, const GuideMap* guides) : piece_(piece), guides_(guides) {}

  bool empty() const { return guides_ == nullptr || guides_->empty(); }

  /// Where v is (see GuideMap::at).
  Vector3 at(int v) const {
    const Vector3& position = piece_.mesh.positions[v];
    const bool is_known = v < static_cast<int>(known_.size()) && known_[v].face == piece_.face[v] && known_[v].position == position;
    return is_known ? known_[v].guide : guides_->at(piece_.face[v], position);
  }

  /// To be called before any `remember`, by one thread.
  void make_room() {
    if (!empty()) known_.resize(piece_.mesh.vertex_count());
  }

  /// For v, which nobody else asks about at the same time.
  void remember(int v) {
    if (!empty()) known_[v] = {piece_.face[v], piece_.mesh.positions[v], at(v)};
  }

 private:
  struct Known {
    int face = -1;
    Vector3 position = Vector3::Zero(), guide = Vector3::Zero();
  };

  const Workpiece& piece_;
  const GuideMap* guides_;
  std::vector<Known> known_;
};

}  // namespace hybrid_quad
