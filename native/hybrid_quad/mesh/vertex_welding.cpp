#include "hybrid_quad/mesh/vertex_welding.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

#include "hybrid_quad/base/disjoint_sets.h"
#include "hybrid_quad/mesh/bucket_sort.h"

namespace hybrid_quad {

namespace {

/// For every vertex the first of those that it is near to, from one to the next; itself for those that are not listed.
std::vector<int> near_places_of(const std::vector<Vector3>& positions, const std::vector<int>& vertices, double tolerance) {
  using Cell = std::array<std::int64_t, 3>;
  const auto cell_of = [&](int v) {
    Cell cell{};
    for (int k = 0; k < 3; ++k) cell[k] = static_cast<std::int64_t>(std::floor(positions[v][k] / tolerance));
    return cell;
  };
  std::vector<std::pair<Cell, int>> cells;
  cells.reserve(vertices.size());
  for (const int v : vertices) cells.emplace_back(cell_of(v), v);
  std::sort(cells.begin(), cells.end());
  DisjointSets sets(positions.size());
  for (const auto& [cell, v] : cells)
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y) {
        const Cell low{cell[0] + x, cell[1] + y, cell[2] - 1};
        for (auto it = std::lower_bound(cells.begin(), cells.end(), std::pair(low, -1));
             it != cells.end() && it->first[0] == low[0] && it->first[1] == low[1] && it->first[2] <= cell[2] + 1; ++it)
          if (it->second < v && (positions[it->second] - positions[v]).norm() <= tolerance) sets.join(it->second, v);
      }
  return sets.sets();
}

}  // namespace

std::vector<int> places_of(const std::vector<Vector3>& positions) {
  struct Point {
    double x, y, z;
    int vertex;
    bool is_at(const Point& o) const { return x == o.x && y == o.y && z == o.z; }
    bool operator<(const Point& o) const { return std::tie(x, y, z, vertex) < std::tie(o.x, o.y, o.z, o.vertex); }
  };
  std::vector<Point> points;
  points.reserve(positions.size());
  for (const Vector3& p : positions) points.push_back({p.x(), p.y(), p.z(), static_cast<int>(points.size())});
  std::sort(points.begin(), points.end());
  std::vector<int> place(positions.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    place[points[i].vertex] = i > 0 && points[i].is_at(points[i - 1]) ? place[points[i - 1].vertex] : points[i].vertex;
  return place;
}

std::vector<std::array<int, 2>> open_edges(const std::vector<std::array<int, 3>>& faces, std::size_t* edge_count) {
  struct Side {
    int low, high, from;
  };
  std::vector<Side> sides;
  sides.reserve(3 * faces.size());
  for (const auto& f : faces)
    for (int i = 0; i < 3; ++i) sides.push_back({std::min(f[i], f[(i + 1) % 3]), std::max(f[i], f[(i + 1) % 3]), f[i]});
  bucket_sort(sides, [](const Side& x) { return x.low; }, [](const Side& x, const Side& y) {
    return std::tie(x.low, x.high, x.from) < std::tie(y.low, y.high, y.from);
  });
  std::vector<std::array<int, 2>> open;
  std::size_t edges = 0;
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j, ++edges) {
    for (j = i + 1; j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high;) ++j;
    if (j == i + 1) open.push_back({sides[i].from, sides[i].from == sides[i].low ? sides[i].high : sides[i].low});
  }
  if (edge_count) *edge_count = edges;
  return open;
}

std::vector<int> welded_vertices(const std::vector<Vector3>& positions, const std::vector<std::array<int, 2>>& open) {
  struct OpenEdge {
    int low_place, high_place, low, high;
  };
  DisjointSets sets(positions.size());
  if (!open.empty()) {
    const std::vector<int> place = places_of(positions);
    std::vector<OpenEdge> edges;
    for (const auto& e : open) {
      const bool forward = place[e[0]] < place[e[1]];
      const int low = forward ? e[0] : e[1], high = forward ? e[1] : e[0];
      if (place[low] != place[high]) edges.push_back({place[low], place[high], low, high});
    }
    std::sort(edges.begin(), edges.end(), [](const OpenEdge& x, const OpenEdge& y) {
      return std::tie(x.low_place, x.high_place, x.low, x.high) < std::tie(y.low_place, y.high_place, y.low, y.high);
    });
    for (std::size_t i = 1; i < edges.size(); ++i)
      if (edges[i].low_place == edges[i - 1].low_place && edges[i].high_place == edges[i - 1].high_place) {
        sets.join(edges[i].low, edges[i - 1].low);
        sets.join(edges[i].high, edges[i - 1].high);
      }
  }
  return sets.sets();
}

std::vector<int> nearly_welded_seams(const std::vector<Vector3>& positions, const std::vector<std::array<int, 2>>& open) {
  constexpr double kGap = 1e-6, kGapOfLength = 1e-4;
  struct Side {
    int low_place, high_place, low, high;
    bool is_forward;
    bool is_beside(const Side& o) const { return low_place == o.low_place && high_place == o.high_place; }
  };
  std::vector<int> ends;
  for (const auto& e : open) ends.insert(ends.end(), e.begin(), e.end());
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  const std::vector<int> place = near_places_of(positions, ends, kGap);
  std::vector<Side> sides;
  for (const auto& e : open) {
    const bool is_forward = place[e[0]] < place[e[1]];
    const int low = is_forward ? e[0] : e[1], high = is_forward ? e[1] : e[0];
    if (place[low] != place[high]) sides.push_back({place[low], place[high], low, high, is_forward});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.low_place, x.high_place, x.low, x.high) < std::tie(y.low_place, y.high_place, y.low, y.high);
  });
  DisjointSets sets(positions.size());
  const auto gap = [&](int v, int w) { return (positions[v] - positions[w]).norm(); };
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j].is_beside(sides[i]);) ++j;
    if (j != i + 2 || sides[i].is_forward == sides[i + 1].is_forward) continue;
    const Side &a = sides[i], &b = sides[i + 1];
    const double length = std::min(gap(a.low, a.high), gap(b.low, b.high));
    if (std::max(gap(a.low, b.low), gap(a.high, b.high)) > kGapOfLength * length) continue;
    sets.join(a.low, b.low);
    sets.join(a.high, b.high);
  }
  return sets.sets();
}

std::vector<int> nearly_welded_vertices(const std::vector<Vector3>& positions, double tolerance) {
  DisjointSets sets(positions.size());
  std::vector<int> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&positions](int v, int w) {
    return positions[v].x() != positions[w].x() ? positions[v].x() < positions[w].x() : v < w;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Vector3 d = positions[order[j]] - positions[order[i]];
      if (d.x() > tolerance) break;
      if (d.norm() <= tolerance) sets.join(order[i], order[j]);
    }
  return sets.sets();
}

double open_edge_share(const std::vector<std::array<int, 3>>& faces) {
  std::size_t edges = 0;
  const std::size_t open = open_edges(faces, &edges).size();
  return edges ? static_cast<double>(open) / static_cast<double>(edges) : 0;
}

}  // namespace hybrid_quad
