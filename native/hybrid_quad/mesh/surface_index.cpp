#include "hybrid_quad/mesh/surface_index.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

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

constexpr int kLeafFaces = 4;
constexpr int kStackSize = 128;  // the tree is halved at every level, so its depth stays below 40

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
  double squared_distance(const Vector3& p) const {
    const auto beyond = [&](int i) { return std::max(std::max(low[i] - p[i], p[i] - high[i]), 0.0); };
    const double x = beyond(0), y = beyond(1), z = beyond(2);
    return x * x + (y * y + z * z);
  }
};

/// A cache line.
struct alignas(64) Node {
  Box box;
  int first = 0, count = 0;  ///< a leaf's range of `order`; count = 0: an inner node
  int left = -1;             ///< the other child is next to it
  int region = -1;           ///< the only region below, or -1 if there are several
};

}  // namespace

struct SurfaceIndex::Tree {
  TriangleMesh mesh;
  std::vector<int> region;
  std::vector<Vector3> normal;
  std::vector<int> order;
  std::vector<std::array<Vector3, 3>> corners;  ///< of the faces in `order`
  std::vector<Node> nodes;

  bool passes(int f, const Filter& filter) const {
    if (filter.region >= 0 && !region.empty() && region[f] != filter.region) return false;
    return filter.min_cosine <= -1 || normal[f].dot(filter.normal) >= filter.min_cosine;
  }
  Box box_of(int f) const {
    Box box;
    for (const int v : mesh.face(f)) box.add({mesh.position(v), mesh.position(v)});
    return box;
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
  void build();
  void bound_nodes();
};

void SurfaceIndex::Tree::build() {
  const int face_count = mesh.face_count();
  if (face_count == 0) return;
  struct Item {
    Vector3 middle;
    int face;
  };
  std::vector<Item> items(face_count);
  normal.resize(face_count);
  for (int f = 0; f < face_count; ++f) {
    const Box box = box_of(f);
    items[f] = {0.5 * (box.low + box.high), f};
    normal[f] = mesh.normal(f);
  }
  struct Task {
    int node, begin, end;
  };
  std::vector<Task> tasks{{0, 0, face_count}};
  nodes.resize(1);
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    if (task.end - task.begin <= kLeafFaces) {
      nodes[task.node].first = task.begin;
      nodes[task.node].count = task.end - task.begin;
      continue;
    }
    Box middles;
    for (int i = task.begin; i < task.end; ++i) middles.add({items[i].middle, items[i].middle});
    int axis = 0;
    (middles.high - middles.low).maxCoeff(&axis);
    const int half = (task.begin + task.end) / 2;
    std::nth_element(items.begin() + task.begin, items.begin() + half, items.begin() + task.end,
                     [axis](const Item& x, const Item& y) {
                       return x.middle[axis] != y.middle[axis] ? x.middle[axis] < y.middle[axis] : x.face < y.face;
                     });
    const int left = static_cast<int>(nodes.size());
    nodes.resize(nodes.size() + 2);
    nodes[task.node].left = left;
    tasks.push_back({left, task.begin, half});
    tasks.push_back({left + 1, half, task.end});
  }
  order.reserve(face_count);
  corners.reserve(face_count);
  for (const Item& item : items) {
    order.push_back(item.face);
    corners.push_back(corners_of(item.face));
  }
  bound_nodes();
}

/// Boxes and regions, children before their parents.
void SurfaceIndex::Tree::bound_nodes() {
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    if (node->count == 0) {
      const Node &left = nodes[node->left], &right = nodes[node->left + 1];
      node->box = left.box;
      node->box.add(right.box);
      node->region = left.region == right.region ? left.region : -1;
      continue;
    }
    node->region = region.empty() ? -1 : region[order[node->first]];
    for (int i = node->first; i < node->first + node->count; ++i) {
      node->box.add(box_of(order[i]));
      if (!region.empty() && region[order[i]] != node->region) node->region = -1;
    }
  }
}

SurfaceIndex::SurfaceIndex(const TriangleMesh& mesh, std::vector<int> face_region) : tree_(std::make_unique<Tree>()) {
  tree_->mesh = mesh;
  tree_->region = std::move(face_region);
  tree_->build();
}

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
    int node;
    double squared_distance;
  };
  Entry stack[kStackSize];
  int size = 0;
  stack[size++] = {0, tree.nodes[0].box.squared_distance(p)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.squared_distance < with_rounding(best.squared_distance, p))) continue;
    const Node& node = tree.nodes[entry.node];
    if (filter.region >= 0 && node.region >= 0 && node.region != filter.region) continue;
    if (node.count > 0) {
      for (int i = node.first; i < node.first + node.count; ++i)
        if (tree.passes(tree.order[i], filter)) Tree::take(p, tree.order[i], tree.corners[i], best);
      continue;
    }
    Entry near{node.left, tree.nodes[node.left].box.squared_distance(p)};
    Entry far{node.left + 1, tree.nodes[node.left + 1].box.squared_distance(p)};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    const double limit = with_rounding(best.squared_distance, p);
    if (far.squared_distance < limit) stack[size++] = far;
    if (near.squared_distance < limit) stack[size++] = near;
  }
  if (best.face < 0) best.squared_distance = 0;
  return best;
}

bool SurfaceIndex::any_in_box(const Vector3& low, const Vector3& high, const std::function<bool(int)>& visit) const {
  const Tree& tree = *tree_;
  if (tree.nodes.empty()) return false;
  int stack[kStackSize];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = tree.nodes[stack[--size]];
    if (!node.box.meets(low, high)) continue;
    if (node.count == 0) {
      stack[size++] = node.left + 1;
      stack[size++] = node.left;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      if (tree.box_of(tree.order[i]).meets(low, high) && visit(tree.order[i])) return true;
  }
  return false;
}

SurfacePoint SurfaceIndex::walk(const Vector3& p, int start) const {
  return walk_to_nearest(tree_->mesh, tree_->region, p, start);
}

}  // namespace hybrid_quad
