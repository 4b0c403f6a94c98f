#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// A point of a set of segments.
struct SegmentPoint {
  int segment = -1;
  double fraction = 0;  ///< from the segment's first end (0) to its second (1)
  double squared_distance = 0;
};

/// The point of one segment, called `id`, that is nearest to p.
SegmentPoint nearest_on_segment(const Vector3& p, const std::array<Vector3, 2>& segment, int id = 0);

/// Nearest points of a set of segments: a bounding-volume tree, ties by segment id.
class SegmentIndex {
 public:
  explicit SegmentIndex(std::vector<std::array<Vector3, 2>> segments);

  /// \returns segment = -1 where there are no segments
  SegmentPoint nearest(const Vector3& p) const;
  /// Where a point of these segments is.
  Vector3 position(const SegmentPoint& point) const {
    const auto& s = segments_[point.segment];
    return s[0] + point.fraction * (s[1] - s[0]);
  }
  int segment_count() const { return static_cast<int>(segments_.size()); }

 private:
  struct Node {
    Vector3 low, high;
    int begin, end;   ///< range of order_
    int left, right;  ///< children, -1 for a leaf
  };
  int build(int begin, int end);

  std::vector<std::array<Vector3, 2>> segments_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace hybrid_quad
