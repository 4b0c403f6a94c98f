#include "hybrid_quad/mesh/topology.h"

#include <vector>

namespace hybrid_quad {

namespace {

/// A gluing of faces of `width` sides each: side s = width f + i, `opposite[s]` the side that it is glued to or -1.
struct Gluing {
  const std::vector<int>& opposite;
  int width;

  int next(int side) const { return side % width == width - 1 ? side - (width - 1) : side + 1; }

  int pieces() const {
    std::vector<char> is_seen(opposite.size() / width, 0);
    std::vector<int> faces;  // of the pieces found so far
    faces.reserve(is_seen.size());
    int count = 0;
    for (int seed = 0; seed < static_cast<int>(is_seen.size()); ++seed) {
      if (is_seen[seed]) continue;
      ++count;
      is_seen[seed] = 1;
      faces.push_back(seed);
      for (std::size_t i = faces.size() - 1; i < faces.size(); ++i)
        for (int side = width * faces[i]; side < width * (faces[i] + 1); ++side) {
          if (opposite[side] < 0 || is_seen[opposite[side] / width]) continue;
          is_seen[opposite[side] / width] = 1;
          faces.push_back(opposite[side] / width);
        }
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
