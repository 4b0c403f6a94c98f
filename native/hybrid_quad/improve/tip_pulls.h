#pragma once

#include <vector>

#include "hybrid_quad/improve/point_pulls.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Holds quads at the tips of parts that are hardly wider than a quad (fingers, horns, ears) while vertices move. Without, the rings of
/// quads around such a part slip off it: shapes alone say where to go, and they are best where it is wide (docs/decisions/0041).
///
/// A tip is where a quad's corners bend by more than 2.5 (of 2 pi, angle defects summed) and the quads around it look many ways (vector
/// areas add up to less than 0.8 of the areas; and the surface below them too, or they are but folded in a plane: its normals add up to
/// less than 0.95 of their number): there the surface is climbed, from the middle of the
/// quad on and away from the vertices around it, to the vertex that is farthest, at most 1.5 edges away. Parts of less than 24 quads, which
/// would be all tips, have none.
class TipPulls {
 public:
  /// Finds the tips from the quads as they are. \pre piece.bind_all
  /// \param released  tips that pull at nothing, as points() has them
  explicit TipPulls(const Workpiece& piece, const std::vector<Vector3>& released = {});

  /// Each tip pulls at the quad that is nearest to it now. To be called when vertices or quads have changed.
  void attach(const EditMesh& mesh);

  bool empty() const { return tips_.empty(); }
  const PointPulls& pulls() const { return pulls_; }
  std::vector<Vector3> points() const;  ///< the tips

 private:
  struct Tip {
    Vector3 point;
    int quad;  ///< that was nearest to it
  };
  std::vector<Tip> tips_;
  PointPulls pulls_;
};

}  // namespace hybrid_quad
