#include "hybrid_quad/mesh/surface_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/mesh/surface_walk.h"

namespace hybrid_quad {

Vector3 nearest_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto nearest_on_segment = [&p](const Vector3& s, const Vector3& e) -> Vector3 {
    const Vector3 d = e - s;
    const double length2 = d.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - s).dot(d) / length2, 0.0, 1.0) : 0.0;
    return s + t * d;
  };
  const Vector3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vector3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return nearest_on_segment(a, b);
  const Vector3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return nearest_on_segment(a, c);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return nearest_on_segment(b, c);
  const double sum = va + vb + vc;
  if (!(sum > 0)) {  // a needle: rounding leaves no inside
    Vector3 best = nearest_on_segment(a, b);
    for (const Vector3& q : {nearest_on_segment(b, c), nearest_on_segment(c, a)})
      if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
    return best;
  }
  return a + ab * (vb / sum) + ac * (vc / sum);
}

namespace {

using Four = Eigen::Array4f;

constexpr int kWidth = 4;
constexpr int kNone = std::numeric_limits<int>::max();
constexpr int kStackSize = 128;  // three entries a level, and ranges are quartered, so that there are fewer than 40 levels

struct Box {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = Vector3::Constant(-std::numeric_limits<double>::infinity());
  void add(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  bool meets(const Vector3& l, const Vector3& h) const {
    return (low.array() <= h.array()).all() && (l.array() <= high.array()).all();
  }
};

constexpr float kUlp = std::numeric_limits<float>::epsilon(), kLeast = std::numeric_limits<float>::min();

float rounded_down(double x) {
  const float f = static_cast<float>(x);
  return f - (kUlp * std::abs(f) + kLeast);
}
float rounded_up(double x) {
  const float f = static_cast<float>(x);
  return f + (kUlp * std::abs(f) + kLeast);
}

/// A box in the tree's units and in single precision, rounded outwards.
struct FloatBox {
  std::array<float, 3> low, high;
};

/// Up to four children with their boxes, side by side so that all are tested at once.
struct alignas(64) Node {
  Four low[3], high[3];
  std::array<int, kWidth> child{kNone, kNone, kNone, kNone};  ///< a node; ~i: the face order[i]; kNone
  std::array<int, kWidth> region{-1, -1, -1, -1};             ///< the only region below, or -1 if there are several

  Node() {
    for (int i = 0; i < 3; ++i) {
      low[i].setConstant(std::numeric_limits<float>::infinity());
      high[i].setConstant(-std::numeric_limits<float>::infinity());
    }
  }
  void put(int lane, const FloatBox& box) {
    for (int i = 0; i < 3; ++i) {
      low[i][lane] = box.low[i];
      high[i][lane] = box.high[i];
    }
  }
  /// Never more than the children's squared distances, but for rounding.
  Four squared_distances(const FloatBox& p) const {
    const auto beyond = [&](int i) -> Four { return (low[i] - p.high[i]).max(p.low[i] - high[i]).max(0.0F); };
    const Four x = beyond(0), y = beyond(1), z = beyond(2);
    return x * x + (y * y + z * z);
  }
  std::array<bool, kWidth> meet(const FloatBox& b) const {
    std::array<bool, kWidth> out;
    for (int k = 0; k < kWidth; ++k) {
      out[k] = child[k] != kNone;
      for (int i = 0; i < 3; ++i) out[k] = out[k] && low[i][k] <= b.high[i] && b.low[i] <= high[i][k];
    }
    return out;
  }
};

}  // namespace

struct SurfaceIndex::Tree {
  TriangleMesh mesh;
  std::vector<int> region;
  std::vector<Vector3> normal;
  std::vector<int> order;
  std::vector<std::array<Vector3, 3>> corners;  ///< of the faces in `order`
  std::vector<Node> nodes;
  Vector3 origin = Vector3::Zero();
  double scale = 1;  ///< of the tree's units, in which the surface has a size of 1: single precision overflows else

  bool passes(int f, const Filter& filter) const { return passes_region(f, filter) && passes_normal(f, filter); }
  bool passes_region(int f, const Filter& filter) const {
    return filter.region < 0 || region.empty() || region[f] == filter.region;
  }
  bool passes_normal(int f, const Filter& filter) const {
    return filter.min_cosine <= -1 || normal[f].dot(filter.normal) >= filter.min_cosine;
  }
  Box box_of(int f) const {
    Box box;
    for (const int v : mesh.face(f)) box.add({mesh.position(v), mesh.position(v)});
    return box;
  }
  FloatBox in_units(const Vector3& low, const Vector3& high) const {
    FloatBox box;
    for (int i = 0; i < 3; ++i) {
      box.low[i] = rounded_down((low[i] - origin[i]) * scale);
      box.high[i] = rounded_up((high[i] - origin[i]) * scale);
    }
    return box;
  }
  /// A bound for Node::squared_distances() of all that may be as near to p as that.
  float limit_of(double squared_distance, const Vector3& p) const {
    constexpr float kMoreThanRounding = 1 + 1e-6F;
    return static_cast<float>(with_rounding(squared_distance, p) * scale * scale) * kMoreThanRounding + kLeast;
  }
  /// Takes face f with the given corners if it is nearer than what `best` holds, or as near and comes first.
  static void take(const Vector3& p, int f, const std::array<Vector3, 3>& corner, SurfacePoint& best) {
    const Vector3 q = nearest_on_triangle(p, corner[0], corner[1], corner[2]);
    const double d = (q - p).squaredNorm();
    const bool comes_first = best.face < 0 || f < best.face;  // of none yet, the distance is the filter's
    if (comes_first ? !(d < with_rounding(best.squared_distance, p)) : !(with_rounding(d, p) < best.squared_distance)) return;
    best = {f, q, d};
  }
  std::array<Vector3, 3> corners_of(int f) const {
    const auto& t = mesh.face(f);
    return {mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])};
  }
  void build(int threads);
  void bound(std::vector<Node>& tree) const;
  static void put_below(Node& node, int lane, const Node& below);
};

namespace {

/// Faces of a tree that is being built.
struct Item {
  Vector3 middle;
  int face;
};

struct Range {
  int begin = 0, end = 0;
  int size() const { return end - begin; }
};

/// Halves a range across its longest side. \returns the second half
Range halve(std::vector<Item>& items, Range& range) {
  Box middles;
  for (int i = range.begin; i < range.end; ++i) middles.add({items[i].middle, items[i].middle});
  int axis = 0;
  (middles.high - middles.low).maxCoeff(&axis);
  const int half = (range.begin + range.end) / 2;
  std::nth_element(items.begin() + range.begin, items.begin() + half, items.begin() + range.end,
                   [axis](const Item& x, const Item& y) {
                     return x.middle[axis] != y.middle[axis] ? x.middle[axis] < y.middle[axis] : x.face < y.face;
                   });
  const Range second{half, range.end};
  range.end = half;
  return second;
}

struct Parts {
  std::array<Range, kWidth> range;
  int count = 0;
};

/// Up to four parts of about the same size.
Parts quartered(std::vector<Item>& items, const Range& range) {
  Parts parts{{range}, 1};
  while (parts.count < kWidth) {
    const auto largest = std::max_element(parts.range.begin(), parts.range.begin() + parts.count,
                                          [](const Range& x, const Range& y) { return x.size() < y.size(); });
    if (largest->size() < 2) break;
    parts.range[parts.count++] = halve(items, *largest);
  }
  return parts;
}

/// The tree of a range, without boxes.
std::vector<Node> tree_of(std::vector<Item>& items, const Range& all) {
  struct Task {
    int node;
    Range range;
  };
  std::vector<Node> nodes(1);
  std::vector<Task> tasks{{0, all}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const Parts parts = quartered(items, task.range);
    for (int k = 0; k < parts.count; ++k) {
      const Range& range = parts.range[k];
      if (range.size() == 1) {
        nodes[task.node].child[k] = ~range.begin;
        continue;
      }
      const int child = static_cast<int>(nodes.size());
      nodes[task.node].child[k] = child;
      tasks.push_back({child, range});
      nodes.emplace_back();
    }
  }
  return nodes;
}

}  // namespace

void SurfaceIndex::Tree::build(int threads) {
  const int face_count = mesh.face_count();
  if (face_count == 0) return;
  std::vector<Item> items(face_count);
  normal.resize(face_count);
  Box all;
  for (int f = 0; f < face_count; ++f) {
    const Box box = box_of(f);
    items[f] = {0.5 * (box.low + box.high), f};
    normal[f] = mesh.normal(f);
    all.add(box);
  }
  origin = 0.5 * (all.low + all.high);
  const double size = (all.high - all.low).maxCoeff();
  scale = size > 0 && std::isfinite(1 / size) ? 1 / size : 1;
  order.resize(face_count);
  corners.resize(face_count);
  // The root's children are trees of their own, which come one after the other behind it.
  const Parts parts = quartered(items, {0, face_count});
  std::array<std::vector<Node>, kWidth> below;
  parallel_for(parts.count, threads, [&](int k) {
    const Range range = parts.range[k];
    below[k] = tree_of(items, range);
    for (int i = range.begin; i < range.end; ++i) {
      order[i] = items[i].face;
      corners[i] = corners_of(items[i].face);
    }
    bound(below[k]);
  });
  nodes.resize(1);
  for (int k = 0; k < parts.count; ++k) {
    const int offset = static_cast<int>(nodes.size());
    nodes[0].child[k] = offset;
    for (Node& node : below[k])
      for (int& child : node.child)
        if (child >= 0 && child != kNone) child += offset;
    nodes.insert(nodes.end(), below[k].begin(), below[k].end());
    put_below(nodes[0], k, nodes[offset]);
  }
}

/// Gives a child the box of all that is below it, and the region.
void SurfaceIndex::Tree::put_below(Node& node, int lane, const Node& below) {
  FloatBox box;
  for (int i = 0; i < 3; ++i) {
    box.low[i] = below.low[i].minCoeff();
    box.high[i] = below.high[i].maxCoeff();
  }
  node.put(lane, box);
  node.region[lane] = below.region[0];
  for (int j = 1; j < kWidth && below.child[j] != kNone; ++j)
    if (below.region[j] != node.region[lane]) node.region[lane] = -1;
}

/// Boxes and regions of a tree, children before their parents.
void SurfaceIndex::Tree::bound(std::vector<Node>& tree) const {
  for (auto node = tree.rbegin(); node != tree.rend(); ++node)
    for (int k = 0; k < kWidth && node->child[k] != kNone; ++k) {
      if (node->child[k] >= 0) {
        put_below(*node, k, tree[node->child[k]]);
        continue;
      }
      const int f = order[~node->child[k]];
      const Box box = box_of(f);
      node->put(k, in_units(box.low, box.high));
      node->region[k] = region.empty() ? -1 : region[f];
    }
}

SurfaceIndex::SurfaceIndex(const TriangleMesh& mesh, std::vector<int> face_region, int threads) : tree_(std::make_unique<Tree>()) {
  tree_->mesh = mesh;
  tree_->region = std::move(face_region);
  tree_->build(threads);
}

SurfaceIndex::SurfaceIndex(const TriangleMesh& mesh, std::vector<int> face_region) : SurfaceIndex(mesh, std::move(face_region), 1) {}

SurfaceIndex::~SurfaceIndex() = default;
SurfaceIndex::SurfaceIndex(SurfaceIndex&&) noexcept = default;
SurfaceIndex& SurfaceIndex::operator=(SurfaceIndex&&) noexcept = default;

const TriangleMesh& SurfaceIndex::mesh() const { return tree_->mesh; }

SurfacePoint SurfaceIndex::nearest(const Vector3& p, const Filter& filter) const {
  const Tree& tree = *tree_;
  SurfacePoint best;
  best.squared_distance = filter.within * filter.within;
  if (tree.nodes.empty()) return best;
  if (filter.hint >= 0 && tree.passes(filter.hint, filter)) {
    const SurfacePoint walked = walk(p, filter.hint);
    if (!tree.passes(walked.face, filter)) Tree::take(p, filter.hint, tree.corners_of(filter.hint), best);
    else if (walked.squared_distance < best.squared_distance) best = walked;
  }

  struct Entry {
    int child;
    float squared_distance;
  };
  const FloatBox place = tree.in_units(p, p);
  float limit = tree.limit_of(best.squared_distance, p);
  Entry stack[kStackSize];
  int size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.squared_distance <= limit)) continue;
    if (entry.child < 0) {
      const int f = tree.order[~entry.child];
      if (!tree.passes_normal(f, filter)) continue;
      Tree::take(p, f, tree.corners[~entry.child], best);
      limit = tree.limit_of(best.squared_distance, p);
      continue;
    }
    const Node& node = tree.nodes[entry.child];
    const Four distances = node.squared_distances(place);
    const int begin = size;
    for (int k = 0; k < kWidth && node.child[k] != kNone; ++k) {
      const float distance = distances[k];
      if (!(distance <= limit)) continue;
      if (filter.region >= 0 && node.region[k] >= 0 && node.region[k] != filter.region) continue;
      int at = size++;  // the nearest comes to the top
      for (; at > begin && stack[at - 1].squared_distance < distance; --at) stack[at] = stack[at - 1];
      stack[at] = {node.child[k], distance};
    }
  }
  if (best.face < 0) best.squared_distance = 0;
  return best;
}

bool SurfaceIndex::any_in_box(const Vector3& low, const Vector3& high, const std::function<bool(int)>& visit) const {
  const Tree& tree = *tree_;
  if (tree.nodes.empty()) return false;
  const FloatBox box = tree.in_units(low, high);
  int stack[kStackSize];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const int child = stack[--size];
    if (child < 0) {
      const int f = tree.order[~child];
      if (tree.box_of(f).meets(low, high) && visit(f)) return true;
      continue;
    }
    const Node& node = tree.nodes[child];
    const std::array<bool, kWidth> meets = node.meet(box);
    for (int k = kWidth; k-- > 0;)
      if (meets[k]) stack[size++] = node.child[k];
  }
  return false;
}

SurfacePoint SurfaceIndex::walk(const Vector3& p, int start) const {
  return walk_to_nearest(tree_->mesh, tree_->region, p, start);
}

}  // namespace hybrid_quad
