#include "hybrid_quad/mesh/segment_index.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace hybrid_quad {

namespace {

constexpr int kLeafSize = 4;

double squared_distance_to_box(const Vector3& p, const Vector3& low, const Vector3& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

}  // namespace

SegmentPoint nearest_on_segment(const Vector3& p, const std::array<Vector3, 2>& segment, int id) {
  const Vector3 along = segment[1] - segment[0];
  const double squared_length = along.squaredNorm();
  const double t = squared_length > 0 ? (p - segment[0]).dot(along) / squared_length : 0.0;
  SegmentPoint point;
  point.segment = id;
  point.fraction = std::min(1.0, std::max(0.0, t));
  point.squared_distance = (segment[0] + point.fraction * along - p).squaredNorm();
  return point;
}

SegmentIndex::SegmentIndex(std::vector<std::array<Vector3, 2>> segments) : segments_(std::move(segments)) {
  order_.resize(segments_.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(segments_.size());
  if (!segments_.empty()) build(0, segment_count());
}

int SegmentIndex::build(int begin, int end) {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  Vector3 middle_low = low, middle_high = high;
  for (int i = begin; i < end; ++i) {
    const auto& s = segments_[order_[i]];
    low = low.cwiseMin(s[0].cwiseMin(s[1]));
    high = high.cwiseMax(s[0].cwiseMax(s[1]));
    middle_low = middle_low.cwiseMin(s[0] + s[1]);
    middle_high = middle_high.cwiseMax(s[0] + s[1]);
  }
  const int id = static_cast<int>(nodes_.size());
  nodes_.push_back({low, high, begin, end, -1, -1});
  if (end - begin <= kLeafSize) return id;
  int axis = 0;
  (middle_high - middle_low).maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
    const double x = segments_[a][0][axis] + segments_[a][1][axis], y = segments_[b][0][axis] + segments_[b][1][axis];
    return std::make_pair(x, a) < std::make_pair(y, b);
  });
  const int left = build(begin, middle), right = build(middle, end);
  nodes_[id].left = left;
  nodes_[id].right = right;
  return id;
}

SegmentPoint SegmentIndex::nearest(const Vector3& p) const {
  SegmentPoint best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return best;
  // Halving ranges: the stack never holds more than one node a level and one more.
  std::array<std::pair<int, double>, 80> stack;
  int size = 0;
  stack[size++] = {0, squared_distance_to_box(p, nodes_[0].low, nodes_[0].high)};
  while (size > 0) {
    const auto [id, bound] = stack[--size];
    if (bound > best.squared_distance) continue;
    const Node& node = nodes_[id];
    if (node.left < 0) {
      for (int i = node.begin; i < node.end; ++i) {
        const SegmentPoint point = nearest_on_segment(p, segments_[order_[i]], order_[i]);
        if (best.segment < 0 || std::make_pair(point.squared_distance, point.segment) <
                                    std::make_pair(best.squared_distance, best.segment))
          best = point;
      }
      continue;
    }
    std::pair<int, double> near{node.left, 0.0}, far{node.right, 0.0};
    near.second = squared_distance_to_box(p, nodes_[near.first].low, nodes_[near.first].high);
    far.second = squared_distance_to_box(p, nodes_[far.first].low, nodes_[far.first].high);
    if (far.second < near.second) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
  return best;
}

}  // namespace hybrid_quad
