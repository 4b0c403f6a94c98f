#include "hybrid_quad/mesh/whiskers.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "hybrid_quad/base/disjoint_sets.h"
#include "hybrid_quad/mesh/degenerate_faces.h"

namespace hybrid_quad {

namespace {

constexpr double kBeyond = 1 + 1e-9;  ///< of a length: farther from one of its ends a vertex is beyond the other

struct Side {
  int low, high;  ///< the edge's ends
  int triangle;
  bool is_same_edge(const Side& o) const { return low == o.low && high == o.high; }
  bool operator<(const Side& o) const { return std::tie(low, high, triangle) < std::tie(o.low, o.high, o.triangle); }
};

/// The sides of all triangles at the vertices of those without area, edge by edge.
std::vector<Side> sides_at(const std::vector<std::array<int, 3>>& triangles, const std::vector<char>& is_flat, std::size_t vertices) {
  std::vector<char> is_near(vertices, 0);
  for (std::size_t f = 0; f < triangles.size(); ++f)
    if (is_flat[f])
      for (const int v : triangles[f]) is_near[v] = 1;
  std::vector<Side> sides;
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const int a = triangles[f][i], b = triangles[f][(i + 1) % 3];
      if (is_near[a] && is_near[b]) sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(f)});
    }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Triangles without area that hang together, and the edges that they have in common with faces with area.
struct FlatPatch {
  std::vector<int> triangles;
  std::vector<std::array<int, 2>> shared;
};

std::vector<FlatPatch> flat_patches(const std::vector<Side>& sides, const std::vector<char>& is_flat) {
  DisjointSets sets(is_flat.size());
  const auto visit_edges = [&](const auto& visit) {
    for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
      int flat = -1;
      bool has_area = false;
      for (end = begin; end < sides.size() && sides[end].is_same_edge(sides[begin]); ++end) {
        const int f = sides[end].triangle;
        if (!is_flat[f]) {
          has_area = true;
          continue;
        }
        if (flat >= 0) sets.join(flat, f);
        flat = f;
      }
      if (flat >= 0 && has_area) visit(flat, sides[begin]);
    }
  };
  visit_edges([](int, const Side&) {});
  std::map<int, FlatPatch> by_set;
  for (int f = 0; f < static_cast<int>(is_flat.size()); ++f)
    if (is_flat[f]) by_set[sets.set_of(f)].triangles.push_back(f);
  visit_edges([&](int f, const Side& side) { by_set[sets.set_of(f)].shared.push_back({side.low, side.high}); });
  std::vector<FlatPatch> patches;
  for (auto& [set, patch] : by_set) patches.push_back(std::move(patch));
  return patches;
}

/// Whether the edges hang together without closing a ring: what is joined along them alone may go and no parts come apart.
bool is_tree(const std::vector<std::array<int, 2>>& edges) {
  std::map<int, int> number;
  for (const auto& e : edges)
    for (const int v : e) number.try_emplace(v, static_cast<int>(number.size()));
  DisjointSets sets(number.size());
  for (const auto& e : edges)
    if (!sets.join(number[e[0]], number[e[1]])) return false;
  return !edges.empty() && number.size() == edges.size() + 1;
}

/// Whether a patch, all on a line, has vertices beyond those of the edges that it is joined along.
bool sticks_out(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& triangles, const FlatPatch& patch) {
  // The ends of the edges on the line: that farthest from any vertex, and that farthest from it.
  std::vector<int> at_edges;
  for (const auto& e : patch.shared) at_edges.insert(at_edges.end(), e.begin(), e.end());
  const auto farthest_from = [&](int v) {
    const auto distance = [&](int w) { return (positions[w] - positions[v]).squaredNorm(); };
    return *std::max_element(at_edges.begin(), at_edges.end(), [&](int x, int y) { return distance(x) < distance(y); });
  };
  const int first = farthest_from(at_edges.front()), last = farthest_from(first);
  const double reach = kBeyond * (positions[last] - positions[first]).norm();
  for (const int f : patch.triangles)
    for (const int v : triangles[f])
      if (std::max((positions[v] - positions[first]).norm(), (positions[v] - positions[last]).norm()) > reach) return true;
  return false;
}

}  // namespace

std::vector<char> whiskers(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& triangles) {
  std::vector<char> is_flat(triangles.size(), 0), is_whisker(triangles.size(), 0);
  for (std::size_t f = 0; f < triangles.size(); ++f)
    is_flat[f] = has_no_area(positions[triangles[f][0]], positions[triangles[f][1]], positions[triangles[f][2]]);
  if (std::count(is_flat.begin(), is_flat.end(), 1) == 0) return is_whisker;

  for (const FlatPatch& patch : flat_patches(sides_at(triangles, is_flat, positions.size()), is_flat))
    if (is_tree(patch.shared) && sticks_out(positions, triangles, patch))
      for (const int f : patch.triangles) is_whisker[f] = 1;
  return is_whisker;
}

}  // namespace hybrid_quad
