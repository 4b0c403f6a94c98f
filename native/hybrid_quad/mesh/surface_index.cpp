#include "hybrid_quad/mesh/surface_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/mesh/needle_axes.h"
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
using Matrix3 = Eigen::Matrix3d;

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

/// The box along other axes that holds a box.
FloatBox turned(const FloatBox& box, const Matrix3& turn) {
  Vector3 middle, half;
  for (int i = 0; i < 3; ++i) {
    middle[i] = 0.5 * (static_cast<double>(box.low[i]) + box.high[i]);
    half[i] = 0.5 * (static_cast<double>(box.high[i]) - box.low[i]);
  }
  middle = turn * middle;
  half = turn.cwiseAbs() * half;
  FloatBox out;
  for (int i = 0; i < 3; ++i) {
    out.low[i] = rounded_down(middle[i] - half[i]);
    out.high[i] = rounded_up(middle[i] + half[i]);
  }
  return out;
}

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

struct Range {
  int begin = 0, end = 0;
  int size() const { return end - begin; }
};

}  // namespace

struct SurfaceIndex::Tree {
  TriangleMesh mesh;
  std::vector<int> region;
  std::vector<Vector3> normal;
  std::vector<int> order;
  std::vector<std::array<Vector3, 3>> corners;  ///< of the faces in `order`
  std::vector<Node> nodes;
  std::vector<Matrix3> turns;  ///< by node: to the axes of its boxes, along needles; empty: all are the coordinate axes
  Vector3 origin = Vector3::Zero();
  double scale = 1;  ///< of the tree's units, in which the surface has a size of 1: single precision overflows else

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
  /// A point along a node's axes. \param here  along the coordinate axes
  FloatBox along_axes_of(int node, const Vector3& p, const FloatBox& here) const {
    if (!is_turned(node)) return here;
    const Vector3 turned = turns[node] * (p - origin) + origin;
    return in_units(turned, turned);
  }
  /// The box along a node's axes that holds what lies between low and high.
  FloatBox along_axes_of(int node, const Vector3& low, const Vector3& high, const FloatBox& here) const {
    if (!is_turned(node)) return here;
    const Vector3 middle = turns[node] * (0.5 * (low + high) - origin) + origin;
    const Vector3 half = turns[node].cwiseAbs() * (0.5 * (high - low));
    return in_units(middle - half, middle + half);
  }
  bool is_turned(int node) const { return !turns.empty() && turns[node](0, 0) != 1; }  // NeedleAxes::turn_of()
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
    best.face = f;
    best.position = q;
    best.squared_distance = d;
  }
  std::array<Vector3, 3> corners_of(int f) const {
    const auto& t = mesh.face(f);
    return {mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])};
  }
  void build(const RunContext& context);
  void bound(const Range& subtree, const RunContext& context);
  static void put_below(Node& node, int lane, const Node& below, const Matrix3* turn);
};

namespace {

/// Faces of a tree that is being built.
struct Item {
  Vector3 middle;
  int face;
};

/// Faces that become a tree, and which way the needles among them lie.
class TreeBuilder {
 public:
  TreeBuilder(std::vector<Item>& items, const NeedleAxes& needles) : items_(items), needles_(needles) {}

  struct Parts {
    std::array<Range, kWidth> range;
    int count = 0;
  };
  /// Up to four parts of about the same size. \param halve  takes the second half off a range and returns it
  template <class Halve>
  static Parts parts_of(const Range& range, const Halve& halve) {
    Parts parts{{range}, 1};
    while (parts.count < kWidth) {
      const auto largest = std::max_element(parts.range.begin(), parts.range.begin() + parts.count,
                                            [](const Range& x, const Range& y) { return x.size() < y.size(); });
      if (largest->size() < 2) break;
      parts.range[parts.count++] = halve(*largest);
    }
    return parts;
  }
  /// \param turn  to the axes across which parts are halved
  Parts quartered(const Range& range, const Matrix3& turn) {
    return parts_of(range, [&](Range& part) { return halve(part, turn); });
  }

  /// How many nodes the tree of so many faces has.
  static int node_count(int faces) {
    const Parts parts = parts_of({0, faces}, cut);
    int count = 1;
    for (int k = 0; k < parts.count; ++k)
      if (parts.range[k].size() > 1) count += node_count(parts.range[k].size());
    return count;
  }

  /// The same across the coordinate axes, and both halves at once.
  Parts quartered_by_halves(const Range& range, int threads) {
    if (range.size() < 2 * kWidth) return quartered(range, Matrix3::Identity());
    std::array<Range, 2> halves{range}, ends;
    halves[1] = halve(halves[0], Matrix3::Identity());
    parallel_for(2, threads, [&](int i) { ends[i] = halve(halves[i], Matrix3::Identity()); });
    const bool is_second_larger = range.size() % 2 != 0;  // and quartered before the first
    return {{halves[0], halves[1], ends[is_second_larger], ends[!is_second_larger]}, kWidth};
  }

  /// To the axes of the boxes of a range.
  Matrix3 turn_of(const Range& range) const {
    if (needles_.empty()) return Matrix3::Identity();
    Matrix3 group = Matrix3::Zero();
    for (int i = range.begin; i < range.end; ++i) needles_.add_to(group, items_[i].face);
    return NeedleAxes::turn_of(group);
  }

  /// Makes the tree of a range, without boxes, of nodes from `root` on: node_count() of them. \param turns  of all nodes; empty where none is turned
  void make_tree(const Range& all, int root, std::vector<Node>& nodes, std::vector<Matrix3>& turns, const RunContext& context) {
    constexpr int kMany = 1 << 16;  // faces, which take some time to halve
    struct Task {
      int node;
      Range range;
    };
    int next = root + 1;
    std::vector<Task> tasks{{root, all}};
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      if (task.range.size() > kMany) context.checkpoint();
      const Matrix3 turn = turn_of(task.range);
      if (!turns.empty()) turns[task.node] = turn;
      const Parts parts = quartered(task.range, turn);
      for (int k = 0; k < parts.count; ++k) {
        const Range& range = parts.range[k];
        const bool is_face = range.size() == 1;
        nodes[task.node].child[k] = is_face ? ~range.begin : next;
        if (!is_face) tasks.push_back({next++, range});
      }
    }
  }

 private:
  /// Halves a range across its longest side. \returns the second half
  Range halve(Range& range, const Matrix3& turn) {
    Box middles;
    for (int i = range.begin; i < range.end; ++i) {
      const Vector3 middle = turn * items_[i].middle;
      middles.add({middle, middle});
    }
    int axis = 0;
    (middles.high - middles.low).maxCoeff(&axis);
    const Vector3 across = turn.row(axis);
    const int begin = range.begin;
    const Range second = cut(range);
    std::nth_element(items_.begin() + begin, items_.begin() + second.begin, items_.begin() + second.end,
                     [&across](const Item& x, const Item& y) {
                       const double a = across.dot(x.middle), b = across.dot(y.middle);
                       return a != b ? a < b : x.face < y.face;
                     });
    return second;
  }
  static Range cut(Range& range) {
    const Range second{(range.begin + range.end) / 2, range.end};
    range.end = second.begin;
    return second;
  }

  std::vector<Item>& items_;
  const NeedleAxes& needles_;
};

}  // namespace

void SurfaceIndex::Tree::build(const RunContext& given_context) {
  const int face_count = mesh.face_count();
  if (face_count == 0) return;
  RunContext context = given_context;
  context.on_progress = nullptr;  // several parts at once have no common progress
  std::vector<Item> items(face_count);
  normal.resize(face_count);
  constexpr int kChunk = 4096;
  std::vector<Box> box_of_chunk((face_count + kChunk - 1) / kChunk);
  parallel_chunks(
      face_count, context,
      [&](int begin, int end) {
        for (int f = begin; f < end; ++f) {
          const Box box = box_of(f);
          items[f] = {0.5 * (box.low + box.high), f};
          normal[f] = mesh.normal(f);
          box_of_chunk[begin / kChunk].add(box);
        }
      },
      kChunk);
  Box all;
  for (const Box& box : box_of_chunk) all.add(box);
  origin = 0.5 * (all.low + all.high);
  const double size = (all.high - all.low).maxCoeff();
  scale = size > 0 && std::isfinite(1 / size) ? 1 / size : 1;
  order.resize(face_count);
  corners.resize(face_count);
  // The root's children are trees of their own, which come one after the other behind it.
  const NeedleAxes needles(mesh);
  TreeBuilder builder(items, needles);
  context.checkpoint();
  const TreeBuilder::Parts parts = builder.quartered_by_halves({0, face_count}, context.threads);
  context.checkpoint();
  std::array<Range, kWidth> subtree;
  int node_count = 1;
  for (int k = 0; k < parts.count; ++k) {
    subtree[k] = {node_count, node_count + TreeBuilder::node_count(parts.range[k].size())};
    node_count = subtree[k].end;
  }
  nodes.resize(node_count);
  if (!needles.empty()) turns.resize(node_count, Matrix3::Identity());
  parallel_for(parts.count, context.threads, [&](int k) {
    const Range range = parts.range[k];
    builder.make_tree(range, subtree[k].begin, nodes, turns, context);
    for (int i = range.begin; i < range.end; ++i) {
      order[i] = items[i].face;
      corners[i] = corners_of(items[i].face);
    }
    bound(subtree[k], context);
  });
  for (int k = 0; k < parts.count; ++k) {
    const int child = subtree[k].begin;
    nodes[0].child[k] = child;
    const Matrix3 turn = needles.empty() ? Matrix3::Identity() : Matrix3(turns[child].transpose());
    put_below(nodes[0], k, nodes[child], needles.empty() ? nullptr : &turn);
  }
}

/// Gives a child the box of all that is below it, and the region. \param turn  from the child's axes to the node's, null where they are the same
void SurfaceIndex::Tree::put_below(Node& node, int lane, const Node& below, const Matrix3* turn) {
  FloatBox box;
  for (int i = 0; i < 3; ++i) {
    box.low[i] = below.low[i].minCoeff();
    box.high[i] = below.high[i].maxCoeff();
  }
  node.put(lane, turn ? turned(box, *turn) : box);
  node.region[lane] = below.region[0];
  for (int j = 1; j < kWidth && below.child[j] != kNone; ++j)
    if (below.region[j] != node.region[lane]) node.region[lane] = -1;
}

/// Boxes and regions of nodes, children before their parents.
void SurfaceIndex::Tree::bound(const Range& subtree, const RunContext& context) {
  for (int n = subtree.end; n-- > subtree.begin;) {
    context.checkpoint_at(n);
    Node& node = nodes[n];
    for (int k = 0; k < kWidth && node.child[k] != kNone; ++k) {
      const int child = node.child[k];
      if (child >= 0) {
        Matrix3 turn;
        if (!turns.empty()) turn = turns[n] * turns[child].transpose();
        put_below(node, k, nodes[child], turns.empty() ? nullptr : &turn);
        continue;
      }
      const int f = order[~child];
      Box box;
      for (const Vector3& corner : corners[~child]) {
        const Vector3 p = turns.empty() ? corner : Vector3(turns[n] * (corner - origin) + origin);
        box.add({p, p});
      }
      node.put(k, in_units(box.low, box.high));
      node.region[k] = region.empty() ? -1 : region[f];
    }
  }
}

SurfaceIndex::SurfaceIndex(const TriangleMesh& mesh, std::vector<int> face_region, const RunContext& context) {
  const auto tree = std::make_shared<Tree>();
  tree->mesh = mesh;
  tree->region = std::move(face_region);
  tree->build(context);
  tree_ = tree;
}

SurfaceIndex SurfaceIndex::without_regions() const {
  SurfaceIndex same = *this;
  same.knows_regions_ = false;
  return same;
}

const std::vector<int>& SurfaceIndex::region() const {
  static const std::vector<int> none;
  return knows_regions_ ? tree_->region : none;
}

bool SurfaceIndex::passes(int face, const Filter& filter) const {
  const std::vector<int>& known = region();
  return (filter.region < 0 || known.empty() || known[face] == filter.region) && tree_->passes_normal(face, filter);
}

const TriangleMesh& SurfaceIndex::mesh() const { return tree_->mesh; }
const Vector3& SurfaceIndex::normal(int face) const { return tree_->normal[face]; }

SurfacePoint SurfaceIndex::nearest(const Vector3& p, const Filter& filter) const {
  const Tree& tree = *tree_;
  SurfacePoint best;
  best.squared_distance = filter.within * filter.within;
  if (tree.nodes.empty()) return best;
  if (filter.hint >= 0 && passes(filter.hint, filter)) {
    const SurfacePoint walked = walk(p, filter.hint);
    if (!passes(walked.face, filter)) Tree::take(p, filter.hint, tree.corners_of(filter.hint), best);
    else if (walked.squared_distance < best.squared_distance) best = walked;
  }

  struct Entry {
    int child;
    float squared_distance;
  };
  const int region = knows_regions_ ? filter.region : -1;
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
      if (filter.any && best.face >= 0) break;
      limit = tree.limit_of(best.squared_distance, p);
      continue;
    }
    const Node& node = tree.nodes[entry.child];
    ++best.boxes_opened;
    const Four distances = node.squared_distances(tree.along_axes_of(entry.child, p, place));
    const int begin = size;
    for (int k = 0; k < kWidth && node.child[k] != kNone; ++k) {
      const float distance = distances[k];
      if (!(distance <= limit)) continue;
      if (region >= 0 && node.region[k] >= 0 && node.region[k] != region) continue;
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
    const std::array<bool, kWidth> meets = node.meet(tree.along_axes_of(child, low, high, box));
    for (int k = kWidth; k-- > 0;)
      if (meets[k]) stack[size++] = node.child[k];
  }
  return false;
}

SurfacePoint SurfaceIndex::walk(const Vector3& p, int start) const {
  return walk_to_nearest(tree_->mesh, region(), p, start);
}

}  // namespace hybrid_quad
