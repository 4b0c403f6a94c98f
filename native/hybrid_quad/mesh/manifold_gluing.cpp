#include "hybrid_quad/mesh/manifold_gluing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "hybrid_quad/mesh/bucket_sort.h"

namespace hybrid_quad {

namespace {

/// Sets of faces, each face with its parity towards its set's root: 1 if it must be flipped where the root is not.
class ParitySets {
 public:
  explicit ParitySets(int n) : parent_(n), parity_(n, 0) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::pair<int, int> find(int f) {
    int root = f, parity = 0;
    while (parent_[root] != root) {
      parity ^= parity_[root];
      root = parent_[root];
    }
    for (int rest = parity; parent_[f] != root && f != root;) {  // compress the path
      const int up = parent_[f], own = parity_[f];
      parent_[f] = root;
      parity_[f] = static_cast<char>(rest);
      rest ^= own;
      f = up;
    }
    return {root, parity};
  }
  /// Joins f and g with the given parity between them; false if they are joined with the other one.
  bool join(int f, int g, int parity) {
    const auto [root_f, parity_f] = find(f);
    const auto [root_g, parity_g] = find(g);
    if (root_f == root_g) return (parity_f ^ parity_g) == parity;
    const int low = std::min(root_f, root_g), high = std::max(root_f, root_g);
    parent_[high] = low;
    parity_[high] = static_cast<char>(parity_f ^ parity_g ^ parity);
    return true;
  }

 private:
  std::vector<int> parent_;
  std::vector<char> parity_;
};

struct EdgeSide {
  int low, high, halfedge;
  bool forward;  ///< runs from low to high
};

class Gluer {
 public:
  Gluer(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& faces, const RunContext& context)
      : positions_(positions), context_(context), sets_(static_cast<int>(faces.size())) {
    out_.faces = faces;
    out_.opposite.assign(3 * faces.size(), -1);
    out_.was_flipped.assign(faces.size(), 0);
  }

  ManifoldGluing run() {
    collect_sides();
    context_.checkpoint();
    glue_simple_edges();
    if (!out_.non_orientable_faces.empty()) {
      for (const auto& range : crowded_) out_.non_manifold_edges.push_back({sides_[range[0]].low, sides_[range[0]].high});
      return std::move(out_);
    }
    glue_crowded_edges();
    orient();
    context_.checkpoint();
    split_vertices();
    return std::move(out_);
  }

 private:
  void collect_sides();
  void glue_simple_edges();
  void cut_twists(const std::vector<int>& twists);
  void glue_crowded_edges();
  void glue_crowded_edge(int begin, int end);
  void orient();
  void split_vertices();
  void glue(int h, int o) {
    out_.opposite[h] = o;
    out_.opposite[o] = h;
  }
  Vector3 direction_from_edge(const EdgeSide& side) const;

  const std::vector<Vector3>& positions_;
  const RunContext& context_;
  ManifoldGluing out_;
  ParitySets sets_;
  std::vector<EdgeSide> sides_;
  std::vector<std::array<int, 2>> crowded_;  ///< ranges of sides_
};

void Gluer::collect_sides() {
  const auto& faces = out_.faces;
  sides_.reserve(3 * faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int i = 0; i < 3; ++i) {
      const int a = faces[f][i], b = faces[f][(i + 1) % 3];
      sides_.push_back({std::min(a, b), std::max(a, b), 3 * f + i, a < b});
    }
  bucket_sort(sides_, [](const EdgeSide& x) { return x.low; }, [](const EdgeSide& x, const EdgeSide& y) {
    return std::tie(x.low, x.high, x.halfedge) < std::tie(y.low, y.high, y.halfedge);
  });
}

void Gluer::glue_simple_edges() {
  const int n = static_cast<int>(sides_.size());
  std::vector<int> turned;  // first sides of edges whose faces turn over
  for (int i = 0, j = 0; i < n; i = j) {
    context_.checkpoint_at(i);
    for (j = i + 1; j < n && sides_[j].low == sides_[i].low && sides_[j].high == sides_[i].high;) ++j;
    if (j - i > 2) crowded_.push_back({i, j});
    if (j - i != 2) continue;
    const int f = sides_[i].halfedge / 3, g = sides_[i + 1].halfedge / 3;
    if (f == g) continue;
    if (sides_[i].forward == sides_[i + 1].forward) {
      turned.push_back(i);
      continue;
    }
    sets_.join(f, g, 0);
    glue(sides_[i].halfedge, sides_[i + 1].halfedge);
  }
  std::vector<int> twists;
  for (const int i : turned) {
    if (sets_.join(sides_[i].halfedge / 3, sides_[i + 1].halfedge / 3, 1)) glue(sides_[i].halfedge, sides_[i + 1].halfedge);
    else twists.push_back(i);
  }
  if (!twists.empty()) cut_twists(twists);
}

/// Leaves twists open where they are short, and gives up on components where they are not.
/// \param twists  first sides of edges that would give a component one side only
void Gluer::cut_twists(const std::vector<int>& twists) {
  constexpr double kShort = 0.15;  // of the root of the area
  const int face_count = static_cast<int>(out_.faces.size());
  std::vector<double> length(face_count, 0), area(face_count, 0);  // of sets
  for (const int i : twists)
    length[sets_.find(sides_[i].halfedge / 3).first] += (positions_[sides_[i].high] - positions_[sides_[i].low]).norm();
  for (int f = 0; f < face_count; ++f) {
    const auto& t = out_.faces[f];
    area[sets_.find(f).first] += 0.5 * (positions_[t[1]] - positions_[t[0]]).cross(positions_[t[2]] - positions_[t[0]]).norm();
  }
  for (int f = 0; f < face_count; ++f) {
    const int set = sets_.find(f).first;
    if (length[set] > kShort * std::sqrt(area[set])) out_.non_orientable_faces.push_back(f);
  }
  for (const int i : twists) out_.twisted_edges.push_back({sides_[i].low, sides_[i].high});
}

/// Unit direction from the edge into the side's face, across the edge.
Vector3 Gluer::direction_from_edge(const EdgeSide& side) const {
  const auto& t = out_.faces[side.halfedge / 3];
  const Vector3& a = positions_[side.low];
  const Vector3 e = (positions_[side.high] - a).normalized();
  const Vector3 d = positions_[t[(side.halfedge % 3 + 2) % 3]] - a;
  return (d - e * e.dot(d)).normalized();
}

/// Pairs the sides of an edge with more than two faces, the flattest pair that agrees in direction first. A pair that
/// would make the surface non-orientable stays apart.
void Gluer::glue_crowded_edge(int begin, int end) {
  struct Pair {
    bool disagrees;
    double cosine;
    int first, second;
  };
  out_.non_manifold_edges.push_back({sides_[begin].low, sides_[begin].high});
  out_.torn_sides += end - begin;
  constexpr int kTooMany = 64;
  if (end - begin > kTooMany) return;
  std::vector<Vector3> direction;
  for (int i = begin; i < end; ++i) direction.push_back(direction_from_edge(sides_[i]));
  std::vector<Pair> pairs;
  for (int i = begin; i < end; ++i)
    for (int j = i + 1; j < end; ++j)
      if (sides_[i].halfedge / 3 != sides_[j].halfedge / 3)
        pairs.push_back({sides_[i].forward == sides_[j].forward, direction[i - begin].dot(direction[j - begin]), i, j});
  std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
    return std::tie(x.disagrees, x.cosine, x.first, x.second) < std::tie(y.disagrees, y.cosine, y.first, y.second);
  });
  for (const Pair& p : pairs) {
    const int g = sides_[p.first].halfedge, h = sides_[p.second].halfedge;
    if (out_.opposite[g] >= 0 || out_.opposite[h] >= 0) continue;
    if (!sets_.join(g / 3, h / 3, p.disagrees)) continue;
    glue(g, h);
    out_.torn_sides -= 2;
  }
}

void Gluer::glue_crowded_edges() {
  for (const auto& range : crowded_) glue_crowded_edge(range[0], range[1]);
}

void Gluer::orient() {
  const int face_count = static_cast<int>(out_.faces.size());
  std::vector<int> flipped(face_count, 0), size(face_count, 0);
  std::vector<double> volume(face_count, 0);  // six times the signed volume, once parities are applied
  std::vector<char> is_open(face_count, 0);
  for (int f = 0; f < face_count; ++f) {
    const auto [root, parity] = sets_.find(f);
    ++size[root];
    flipped[root] += parity;
    const auto& t = out_.faces[f];
    const double v = positions_[t[0]].dot(positions_[t[1]].cross(positions_[t[2]]));
    volume[root] += parity ? -v : v;
    for (int i = 0; i < 3; ++i)
      if (out_.opposite[3 * f + i] < 0) is_open[root] = 1;
  }
  for (int f = 0; f < face_count; ++f) {
    const auto [root, parity] = sets_.find(f);
    bool turn = 2 * flipped[root] > size[root];
    const bool was_mixed = flipped[root] > 0 && flipped[root] < size[root];
    if (was_mixed && !is_open[root] && volume[root] != 0) turn = volume[root] < 0;
    out_.was_flipped[f] = static_cast<char>((parity != 0) != turn);
  }
  // (a, b, c) becomes (a, c, b): its edges ab, bc, ca are found as ca, bc, ab, so half-edges 0 and 2 change places.
  const auto moved = [&](int h) { return h >= 0 && out_.was_flipped[h / 3] ? 3 * (h / 3) + 2 - h % 3 : h; };
  std::vector<int> opposite(out_.opposite.size());
  for (int h = 0; h < 3 * face_count; ++h) opposite[moved(h)] = moved(out_.opposite[h]);
  out_.opposite = std::move(opposite);
  for (int f = 0; f < face_count; ++f)
    if (out_.was_flipped[f]) std::swap(out_.faces[f][1], out_.faces[f][2]);
}

/// Gives every fan a vertex of its own; the first fan of a vertex comes first.
void Gluer::split_vertices() {
  const int halfedge_count = static_cast<int>(out_.opposite.size());
  const auto next = [](int h) { return h % 3 == 2 ? h - 2 : h + 1; };
  const auto previous = [](int h) { return h % 3 == 0 ? h + 2 : h - 1; };
  std::vector<int> fan(halfedge_count, -1);  // by outgoing half-edge
  std::vector<int> source;
  for (int start = 0; start < halfedge_count; ++start) {
    context_.checkpoint_at(start);
    if (fan[start] >= 0) continue;
    const int id = static_cast<int>(source.size());
    source.push_back(out_.faces[start / 3][start % 3]);
    int h = start;
    while (h >= 0 && fan[h] < 0) {
      fan[h] = id;
      h = out_.opposite[previous(h)];
    }
    for (h = start; out_.opposite[h] >= 0;) {
      h = next(out_.opposite[h]);
      if (fan[h] >= 0) break;
      fan[h] = id;
    }
  }
  // Vertices keep the input's order.
  std::vector<int> order(source.size()), rank(source.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&source](int x, int y) { return source[x] < source[y]; });
  for (int i = 0; i < static_cast<int>(order.size()); ++i) {
    rank[order[i]] = i;
    const int v = source[order[i]];
    if (!out_.source_vertex.empty() && out_.source_vertex.back() == v &&
        (out_.non_manifold_vertices.empty() || out_.non_manifold_vertices.back() != v))
      out_.non_manifold_vertices.push_back(v);
    out_.source_vertex.push_back(v);
    out_.positions.push_back(positions_[v]);
  }
  for (int h = 0; h < halfedge_count; ++h) out_.faces[h / 3][h % 3] = rank[fan[h]];
}

}  // namespace

ManifoldGluing glue_triangles(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& faces,
                              const RunContext& context) {
  return Gluer(positions, faces, context).run();
}

}  // namespace hybrid_quad
