#include "hybrid_quad/mesh/copied_parts.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <tuple>

#include "hybrid_quad/mesh/bucket_sort.h"
#include "hybrid_quad/mesh/vertex_welding.h"

namespace hybrid_quad {

namespace {

struct Part {
  int size = 0;
  double volume = 0;  ///< six times, about the origin; 0 where it is open
};

std::vector<int> part_of_vertices(std::size_t count, const std::vector<std::array<int, 3>>& faces) {
  std::vector<int> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& f : faces)
    for (const int v : {f[1], f[2]}) {
      const int a = root(f[0]), b = root(v);
      parent[std::max(a, b)] = std::min(a, b);
    }
  for (int v = 0; v < static_cast<int>(count); ++v) parent[v] = root(v);
  return parent;
}

/// By the first vertex of each.
std::vector<Part> parts_of(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& faces,
                           const std::vector<int>& part_of) {
  std::vector<Part> parts(positions.size());
  for (const auto& f : faces) {
    Part& part = parts[part_of[f[0]]];
    ++part.size;
    part.volume += positions[f[0]].dot(positions[f[1]].cross(positions[f[2]]));
  }
  for (const auto& edge : open_edges(faces)) parts[part_of[edge[0]]].volume = 0;
  return parts;
}

}  // namespace

std::vector<char> copied_parts(const std::vector<Vector3>& positions, const std::vector<std::array<int, 3>>& faces) {
  std::vector<char> is_copied(faces.size(), 0);
  const std::vector<int> place = places_of(positions);
  // Parts have no vertex in common: without two at one place, no triangles lie in one.
  int v = 0;
  if (std::all_of(place.begin(), place.end(), [&v](int first) { return first == v++; })) return is_copied;
  const std::vector<int> part_of = part_of_vertices(positions.size(), faces);
  // Groups of triangles in one place, with the parts that have one there.
  using Key = std::tuple<std::array<int, 3>, int>;
  std::vector<Key> keys;
  keys.reserve(faces.size());
  for (const auto& f : faces) {
    std::array<int, 3> key{place[f[0]], place[f[1]], place[f[2]]};
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, part_of[f[0]]);
  }
  bucket_sort(keys, [](const Key& key) { return std::get<0>(key)[0]; }, std::less<>());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<std::vector<int>> groups_of(positions.size());
  std::vector<int> cover;  // parts that a group has, those that went left out
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || std::get<0>(keys[i]) != std::get<0>(keys[i - 1])) cover.push_back(0);
    ++cover.back();
    groups_of[std::get<1>(keys[i])].push_back(static_cast<int>(cover.size()) - 1);
  }
  if (std::none_of(cover.begin(), cover.end(), [](int parts) { return parts > 1; })) return is_copied;

  const std::vector<Part> parts = parts_of(positions, faces, part_of);
  std::vector<int> order;
  for (int p = 0; p < static_cast<int>(parts.size()); ++p)
    if (parts[p].size > 0) order.push_back(p);
  std::sort(order.begin(), order.end(), [&parts](int a, int b) {
    return std::make_tuple(parts[a].size, parts[a].volume, -a) < std::make_tuple(parts[b].size, parts[b].volume, -b);
  });
  std::vector<char> goes(parts.size(), 0);
  for (const int p : order) {
    goes[p] = std::all_of(groups_of[p].begin(), groups_of[p].end(), [&cover](int group) { return cover[group] > 1; });
    if (!goes[p]) continue;
    for (const int group : groups_of[p]) --cover[group];
  }
  for (std::size_t f = 0; f < faces.size(); ++f) is_copied[f] = goes[part_of[faces[f][0]]];
  return is_copied;
}

}  // namespace hybrid_quad
