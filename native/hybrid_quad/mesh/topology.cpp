#include "hybrid_quad/mesh/topology.h"

#include <algorithm>
#include <vector>

namespace hybrid_quad {

namespace {

/// A gluing of faces of `width` sides each: side s = width f + i, `opposite[s]` the side that it is glued to or -1.
struct Gluing {
  const std::vector<int>& opposite;
  int width;

  int next(int side) const { return side % width == width - 1 ? side - (width - 1) : side + 1; }

  /// Of each face, from 0 in the order of their first faces.
  std::vector<int> pieces() const {
    std::vector<int> piece(opposite.size() / width, -1);
    std::vector<int> faces;  // of the pieces found so far
    faces.reserve(piece.size());
    int count = 0;
    for (int seed = 0; seed < static_cast<int>(piece.size()); ++seed) {
      if (piece[seed] >= 0) continue;
      piece[seed] = count;
      faces.push_back(seed);
      for (std::size_t i = faces.size() - 1; i < faces.size(); ++i)
        for (int side = width * faces[i]; side < width * (faces[i] + 1); ++side) {
          if (opposite[side] < 0 || piece[opposite[side] / width] >= 0) continue;
          piece[opposite[side] / width] = count;
          faces.push_back(opposite[side] / width);
        }
      ++count;
    }
    return piece;
  }

  int piece_count() const {
    const std::vector<int> piece = pieces();
    return piece.empty() ? 0 : *std::max_element(piece.begin(), piece.end()) + 1;
  }

  /// \param vertex  of each side, where it begins
  std::vector<int> euler_characteristics(const std::vector<int>& vertex) const {
    const std::vector<int> piece = pieces();
    std::vector<int> sums(piece_count(), 0);
    std::vector<char> is_seen(vertex.empty() ? 0 : *std::max_element(vertex.begin(), vertex.end()) + 1, 0);
    for (int side = 0; side < static_cast<int>(opposite.size()); ++side) {
      int& sum = sums[piece[side / width]];
      sum += side % width == 0;
      sum -= opposite[side] < side;  // once an edge
      sum += !is_seen[vertex[side]];
      is_seen[vertex[side]] = 1;
    }
    std::sort(sums.begin(), sums.end());
    return sums;
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
  return {Gluing{mesh.opposites(), 3}.piece_count(), mesh.euler_characteristic(), border_loops_of(mesh)};
}

Topology topology_of(const QuadComplex& complex) {
  const Gluing gluing{complex.opposite, 4};
  return {gluing.piece_count(), euler_characteristic(complex), gluing.border_loops()};
}

Topology topology_of(const QuadMesh& mesh) { return topology_of(complex_of_quads(mesh.positions, mesh.quads)); }

std::vector<int> euler_characteristics_of_pieces(const TriangleMesh& mesh) {
  std::vector<int> vertex;
  vertex.reserve(mesh.halfedge_count());
  for (const auto& face : mesh.faces()) vertex.insert(vertex.end(), face.begin(), face.end());
  return Gluing{mesh.opposites(), 3}.euler_characteristics(vertex);
}

std::vector<int> euler_characteristics_of_pieces(const QuadMesh& mesh) {
  const QuadComplex complex = complex_of_quads(mesh.positions, mesh.quads);
  return Gluing{complex.opposite, 4}.euler_characteristics(complex.vertex);
}

}  // namespace hybrid_quad
