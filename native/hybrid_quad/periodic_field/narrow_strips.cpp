#include "hybrid_quad/periodic_field/narrow_strips.h"

#include <algorithm>
#include <array>

namespace hybrid_quad {

namespace {

/// A walk from a feature straight across the grid ends after one quad, or after this many faces.
constexpr int kMostFaces = 200;
/// Strips narrower than this (in quads) are tips of wedges, where two features meet.
constexpr double kNarrowest = 0.05;
/// Strips narrower than this get one row whatever is asked: two would be more than four times as long as wide.
constexpr double kRoomForRows = 0.5;

double cross(const Vector2& x, const Vector2& y) { return x[0] * y[1] - x[1] * y[0]; }

struct FaceOnWalk {
  int face;
  int coordinate;  ///< the one that changes along the walk, in this face's gauge
};

/// Walks along one grid direction through faces unfolded into the grid's plane.
class StripWalk {
 public:
  StripWalk(const TriangleMesh& mesh, const FrameField& frames, const GridMeasure& measure)
      : mesh_(mesh), frames_(frames), measure_(measure) {}

  /// From the point at share t of feature half-edge `start` into its face, across the feature.
  /// \return the width of the strip in quads, or 0 if no parallel feature is met within `widest` quads
  double width(int start, double t, double widest) {
    faces_.clear();
    chain_.clear();
    int entry = start, coordinate = 1 - measure_.axis[start];
    Vector2 direction(0, 0);
    direction[coordinate] = 1;
    if (cross(measure_.along[start], direction) < 0) direction = -direction;
    double walked = 0;
    while (static_cast<int>(faces_.size()) < kMostFaces && walked < widest) {
      faces_.push_back({entry / 3, coordinate});
      const Vector2 b = measure_.along[entry], c = b + measure_.along[TriangleMesh::next(entry)], x = t * b;
      if (!(cross(b, direction) > 0) || !(cross(b, c) > 0)) return 0;
      const bool exits_right = cross(direction, c - x) > 0;
      const Vector2 from = exits_right ? b : c, to = exits_right ? c : Vector2(0, 0);
      const double across = cross(direction, to - from);
      if (across == 0) return 0;
      const double share = std::clamp(cross(direction, x - from) / across, 0.0, 1.0);
      walked += std::max(0.0, (from + share * (to - from) - x).dot(direction));
      if (exits_right)
        chain_.push_back({TriangleMesh::previous(entry),
                          {-static_cast<int>(direction[0]), -static_cast<int>(direction[1])}});
      const int exit = exits_right ? TriangleMesh::next(entry) : TriangleMesh::previous(entry);
      if (measure_.axis[exit] >= 0)
        return measure_.axis[exit] == 1 - coordinate && walked < widest ? walked : 0;
      entry = mesh_.opposite(exit);
      if (entry < 0) return 0;
      direction = turned(direction, frames_.matching[exit]);
      coordinate = direction[0] != 0 ? 0 : 1;
      t = 1 - share;
    }
    return 0;
  }

  const std::vector<FaceOnWalk>& faces() const { return faces_; }
  /// Edges along the walk's left side, from the first feature to the last.
  const std::vector<StripEdge>& chain() const { return chain_; }

 private:
  const TriangleMesh& mesh_;
  const FrameField& frames_;
  const GridMeasure& measure_;
  std::vector<FaceOnWalk> faces_;
  std::vector<StripEdge> chain_;
};

}  // namespace

void widen_narrow_strips(const TriangleMesh& mesh, const FrameField& frames, int rows, GridMeasure& measure) {
  std::vector<std::array<double, 2>> factor(mesh.face_count(), {1, 1});
  StripWalk walk(mesh, frames, measure);
  bool any = false;
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (measure.axis[h] < 0) continue;
    for (const double t : {1.0 / 6, 0.5, 5.0 / 6}) {
      const double width = walk.width(h, t, rows);
      if (width < kNarrowest) continue;
      any = true;
      const double wanted = width < kRoomForRows ? 1 : rows;
      for (const FaceOnWalk& on : walk.faces())
        factor[on.face][on.coordinate] = std::max(factor[on.face][on.coordinate], wanted / width);
    }
  }
  if (!any) return;
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    for (int c = 0; c < 2; ++c) measure.along[h][c] *= factor[h / 3][c];
}

std::vector<std::vector<StripEdge>> find_strips(const TriangleMesh& mesh, const FrameField& frames,
                                                const GridMeasure& measure, double widest) {
  std::vector<std::vector<StripEdge>> strips;
  StripWalk walk(mesh, frames, measure);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (measure.axis[h] >= 0 && walk.width(h, 0.5, widest) > 0) strips.push_back(walk.chain());
  return strips;
}

}  // namespace hybrid_quad
