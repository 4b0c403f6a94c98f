#include "quad_complexes.h"

#include <cmath>
#include <map>

namespace hybrid_quad::test {

namespace {

/// Vertices and their arrays from the gluing alone.
QuadComplex from_gluing(std::vector<int> opposite, const std::vector<Vector3>& dart_origin) {
  QuadComplex c;
  c.vertex = vertex_orbits(opposite);
  c.opposite = std::move(opposite);
  c.curve.assign(c.opposite.size(), -1);
  for (std::size_t d = 0; d < c.vertex.size(); ++d)
    if (c.vertex[d] == static_cast<int>(c.positions.size())) c.positions.push_back(dart_origin[d]);
  c.kind.assign(c.positions.size(), VertexKind::kFree);
  c.anchor.assign(c.positions.size(), 0);
  c.near_face.assign(c.positions.size(), -1);
  return c;
}

/// n x m quads; columns wrap around, rows too if asked, the last one to the first one by `shift` quads further.
QuadComplex wrapped(int n, int m, bool rows_wrap, int shift = 0) {
  std::vector<int> opposite(4 * n * m, -1);
  std::vector<Vector3> origin(4 * n * m);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int q = j * n + i, right = j * n + (i + 1) % n;
      opposite[4 * q + 1] = 4 * right + 3;
      opposite[4 * right + 3] = 4 * q + 1;
      if (j + 1 < m || rows_wrap) {
        const int up = j + 1 < m ? (j + 1) * n + i : (i + shift) % n;
        opposite[4 * q + 2] = 4 * up;
        opposite[4 * up] = 4 * q + 2;
      }
      const int di[4] = {0, 1, 1, 0}, dj[4] = {0, 0, 1, 1};
      for (int k = 0; k < 4; ++k) {
        const double angle = 2 * M_PI * (i + di[k]) / n, tube = 2 * M_PI * (j + dj[k]) / m;
        origin[4 * q + k] = rows_wrap ? Vector3((2 + std::cos(tube)) * std::cos(angle),
                                                (2 + std::cos(tube)) * std::sin(angle), std::sin(tube))
                                      : Vector3(std::cos(angle), std::sin(angle), j + dj[k]);
      }
    }
  return from_gluing(std::move(opposite), origin);
}

}  // namespace

QuadComplex quad_box(int n, int m, int k) {
  const int size[3] = {n, m, k};
  std::map<std::array<int, 3>, int> id;
  std::vector<Vector3> positions;
  std::vector<std::array<int, 4>> quads;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [at, added] = id.insert({p, static_cast<int>(positions.size())});
    if (added) positions.push_back(Vector3(p[0], p[1], p[2]));
    return at->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      for (int i = 0; i < size[a]; ++i)
        for (int j = 0; j < size[b]; ++j) {
          std::array<int, 4> quad;
          const int da[4] = {0, 1, 1, 0}, db[4] = {0, 0, 1, 1};
          for (int c = 0; c < 4; ++c) {
            std::array<int, 3> p{};
            p[axis] = side * size[axis];
            p[a] = i + da[c];
            p[b] = j + db[c];
            quad[side ? c : 3 - c] = vertex(p);
          }
          quads.push_back(quad);
        }
    }
  return complex_of_quads(positions, quads);
}

QuadComplex quad_grid(int n, int m) {
  std::vector<Vector3> positions;
  std::vector<std::array<int, 4>> quads;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) positions.push_back(Vector3(i, j, 0));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int v = j * (n + 1) + i;
      quads.push_back({v, v + 1, v + n + 2, v + n + 1});
    }
  return complex_of_quads(positions, quads);
}

QuadComplex quad_tube(int n, int m) { return wrapped(n, m, false); }
QuadComplex quad_torus(int n, int m, int shift) { return wrapped(n, m, true, shift); }

QuadComplex quad_cone(int n) {
  QuadComplex grid = quad_grid(n, n);
  for (int i = 0; i < n; ++i) {
    const int bottom = 4 * i, left = 4 * (i * n) + 3;
    grid.opposite[bottom] = left;
    grid.opposite[left] = bottom;
  }
  std::vector<Vector3> origin;
  for (const int v : grid.vertex) origin.push_back(grid.positions[v]);
  return from_gluing(std::move(grid.opposite), origin);
}

QuadComplex pillow() {
  std::vector<int> opposite(8);
  for (int i = 0; i < 4; ++i) {
    opposite[i] = 4 + (3 - i);
    opposite[4 + (3 - i)] = i;
  }
  std::vector<Vector3> origin(8);
  const Vector3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (int i = 0; i < 4; ++i) {
    origin[i] = corners[i];
    origin[4 + (3 - i)] = corners[(i + 1) & 3];
  }
  return from_gluing(opposite, origin);
}

std::vector<int> border_loop_lengths(const QuadComplex& c) {
  std::vector<int> lengths;
  std::vector<char> seen(c.opposite.size(), 0);
  for (int seed = 0; seed < static_cast<int>(c.opposite.size()); ++seed) {
    if (c.opposite[seed] >= 0 || seen[seed]) continue;
    int length = 0;
    for (int d = seed; !seen[d]; ++length) {
      seen[d] = 1;
      d = QuadComplex::next(d);
      while (c.opposite[d] >= 0) d = QuadComplex::next(c.opposite[d]);
    }
    lengths.push_back(length);
  }
  return lengths;
}

}  // namespace hybrid_quad::test
