#include "hybrid_quad/mesh/polygon_cuts.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace hybrid_quad {

namespace {

/// The finalizer of SplitMix64 (Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators, 2014).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

std::uint64_t key_of(const Vector3& p) {
  std::uint64_t key = 0;
  for (int i = 0; i < 3; ++i) {
    const double x = p[i] + 0.0;  // of the two zeros the positive one
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    key = mixed(key + 0x9e3779b97f4a7c15ULL + bits);
  }
  return key;
}

/// For each corner of one polygon the corner of another that is at its place, where both pass the same places in the same cycle,
/// either way round; else empty.
std::vector<int> matching_corners(const std::vector<Vector3>& positions, const std::vector<int>& one, const std::vector<int>& other) {
  const std::size_t n = one.size();
  if (other.size() != n) return {};
  for (std::size_t start = 0; start < n; ++start)
    for (const bool is_reversed : {false, true}) {
      const auto place = [&](std::size_t i) { return (is_reversed ? start + n - i : start + i) % n; };
      std::size_t same = 0;
      while (same < n && positions[one[same]] == positions[other[place(same)]]) ++same;
      if (same < n) continue;
      std::vector<int> match;
      for (std::size_t i = 0; i < n; ++i) match.push_back(static_cast<int>(place(i)));
      return match;
    }
  return {};
}

}  // namespace

PolygonCuts::PolygonCuts(const std::vector<Vector3>& positions, const PolygonSoup& soup) : positions_(positions) {
  if (std::none_of(soup.face_sizes.begin(), soup.face_sizes.end(), [](int size) { return size > 3; })) return;
  std::vector<std::uint64_t> vertex_key;
  vertex_key.reserve(positions.size());
  for (const Vector3& p : positions) vertex_key.push_back(key_of(p));
  std::size_t first = 0;
  for (const int size : soup.face_sizes) {
    std::uint64_t key = 0;
    for (int k = 0; k < size; ++k) {
      const int v = soup.face_vertices[first + k], after = soup.face_vertices[first + (k + 1) % size];
      if (v != after) key += vertex_key[v];
    }
    key_.push_back(size > 3 ? key : 0);
    first += size;
  }
  std::vector<std::uint64_t> sorted = key_;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint64_t& key : key_) {
    const auto found = std::lower_bound(sorted.begin(), sorted.end(), key);
    if (found + 1 == sorted.end() || *(found + 1) != key) key = 0;
  }
}

std::vector<std::array<int, 3>> PolygonCuts::like_a_copy(int polygon, const std::vector<int>& corners) const {
  if (key_.empty() || key_[polygon] == 0) return {};
  const auto cuts = cuts_.find(key_[polygon]);
  if (cuts == cuts_.end()) return {};
  for (const Cut& cut : cuts->second) {
    const std::vector<int> match = matching_corners(positions_, cut.corners, corners);
    if (match.empty()) continue;
    const bool is_reversed = (match[0] + 1) % static_cast<int>(match.size()) != match[1];
    std::vector<std::array<int, 3>> triangles = cut.triangles;
    for (auto& t : triangles) {
      for (int& v : t) v = corners[match[std::find(cut.corners.begin(), cut.corners.end(), v) - cut.corners.begin()]];
      if (is_reversed) std::swap(t[1], t[2]);
    }
    return triangles;
  }
  return {};
}

void PolygonCuts::keep(int polygon, const std::vector<int>& corners, const std::vector<std::array<int, 3>>& triangles) {
  if (!key_.empty() && key_[polygon] != 0) cuts_[key_[polygon]].push_back({corners, triangles});
}

}  // namespace hybrid_quad
