#include "hybrid_quad/mesh/topology.h"

#include <numeric>
#include <vector>

namespace hybrid_quad {

namespace {

/// A gluing of faces of `width` sides each: side s = width f + i, `opposite[s]` the side that it is glued to or -1.
struct Gluing {
  const std::vector<int>& opposite;
  int width;

  int next(int side) const { return side % width == width - 1 ? side - (width - 1) : side + 1; }

  int pieces() const {
    std::vector<int> parent(opposite.size() / width);
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int i) {
      while (parent[i] != i) i = parent[i] = parent[parent[i]];
      return i;
    };
    int count = static_cast<int>(parent.size());
    for (int side = 0; side < static_cast<int>(opposite.size()); ++side) {
      if (opposite[side] < 0) continue;
      const int a = root(side / width), b = root(opposite[side] / width);
      if (a == b) continue;
      parent[a] = b;
      --count;
    }
    return count;
  }

  int border_loops() const {
    std::vector<char> is_seen(opposite.size(), 0);
    int count = 0;
    for (int start = 0; start < static_cast<int>(opposite.size()); ++start) {
      if (opposite[start] >= 0 || is_seen[start]) continue;
      ++count;
      for (int side = start; !is_seen[side];) {
        is_seen[side] = 1;
        side = next(side);
        while (opposite[side] >= 0) side = next(opposite[side]);
      }
    }
    return count;
  }
};

}  // namespace

int border_loops_of(const TriangleMesh& mesh) { return Gluing{mesh.opposites(), 3}.border_loops(); }

Topology topology_of(const TriangleMesh& mesh) {
  return {Gluing{mesh.opposites(), 3}.pieces(), mesh.euler_characteristic(), border_loops_of(mesh)};
}

Topology topology_of(const QuadComplex& complex) {
  const Gluing gluing{complex.opposite, 4};
  return {gluing.pieces(), euler_characteristic(complex), gluing.border_loops()};
}

Topology topology_of(const QuadMesh& mesh) { return topology_of(complex_of_quads(mesh.positions, mesh.quads)); }

}  // namespace hybrid_quad
