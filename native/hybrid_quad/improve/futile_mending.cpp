#include "hybrid_quad/improve/futile_mending.h"

#include <cmath>
#include <vector>

namespace hybrid_quad {

namespace {

/// splitmix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace

std::uint64_t FutileMending::shape_of(const Workpiece& piece, int q) const {
  std::uint64_t hash = 0;
  for (const int v : piece.mesh.quad(q))
    for (int i = 0; i < 3; ++i) hash = mixed(hash ^ static_cast<std::uint64_t>(std::llround(piece.mesh.positions[v][i] / unit_)));
  return hash;
}

std::uint64_t FutileMending::surroundings(const Workpiece& piece, int q) const {
  std::vector<int> quads{q};
  std::unordered_set<int> seen{q};
  for (std::size_t begin = 0, ring = 0; ring < kRings; ++ring) {
    const std::size_t end = quads.size();
    for (; begin < end; ++begin)
      for (const int v : piece.mesh.quad(quads[begin]))
        for (const int other : piece.mesh.quads_at(v))
          if (seen.insert(other).second) quads.push_back(other);
  }
  // A sum: quads have other numbers, and are met in another order, in another mesh.
  std::uint64_t sum = mixed(shape_of(piece, q));
  for (const int other : quads) sum += shape_of(piece, other);
  return sum;
}

}  // namespace hybrid_quad
