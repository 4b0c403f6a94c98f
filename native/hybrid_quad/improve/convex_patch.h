#pragma once

#include <optional>
#include <vector>

#include "hybrid_quad/improve/edit_mesh.h"

namespace hybrid_quad {

/// A disk of quads between features whose border turns inwards nowhere, as grid lines should see it: where the border follows
/// features around a vertex, the angle there says how many quads that should have; elsewhere it keeps those it has.
struct ConvexPatch {
  std::vector<int> quads;
  std::vector<int> inside;               ///< vertices, none of them on the border
  /// Vertices from corner to corner, counterclockwise, ends included; one side that ends where it begins if none is a corner.
  std::vector<std::vector<int>> sides;
  bool has_corners = true;
  int irregular = 0;  ///< vertices inside with other than four quads, and those on features with others than they should have
};

/// A growing set of quads around some vertices.
class PatchGrower {
 public:
  /// \param least_irregular  vertices that could be more regular, without which a set is no patch
  PatchGrower(const EditMesh& mesh, int most_quads, int least_irregular = 2)
      : mesh_(mesh), most_quads_(most_quads), least_irregular_(least_irregular) {}

  /// Starts with the quads around v. \returns whether there is room to grow
  bool start(int v);
  /// Adds all quads that touch the set and that no feature keeps apart.
  bool grow();
  /// The set as a patch; nothing where it is no disk, its border is not convex, or it holds too few irregular vertices.
  std::optional<ConvexPatch> patch() const;

 private:
  bool lies_on_inner_feature(int v) const;
  bool take(int q);
  bool take_around(int v);
  bool fill_notches();
  int count_at(int v) const;
  int wanted_at(int before, int v, int after) const;
  bool holds_irregular_vertices(const std::vector<int>& vertices) const;

  const EditMesh& mesh_;
  int most_quads_, least_irregular_;
  std::vector<int> quads_;
  std::vector<char> taken_;  ///< by quad
  std::size_t looked_at_ = 0;  ///< quads whose vertices turn nowhere inwards
};

}  // namespace hybrid_quad
