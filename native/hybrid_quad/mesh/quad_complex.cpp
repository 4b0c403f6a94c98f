#include "hybrid_quad/mesh/quad_complex.h"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/bucket_sort.h"

namespace hybrid_quad {

QuadComplex complex_of_quads(std::vector<Vector3> positions, const std::vector<std::array<int, 4>>& quads) {
  QuadComplex complex;
  const int darts = 4 * static_cast<int>(quads.size());
  complex.vertex.reserve(darts);
  for (const auto& quad : quads) complex.vertex.insert(complex.vertex.end(), quad.begin(), quad.end());
  complex.opposite.assign(darts, -1);
  complex.curve.assign(darts, -1);
  complex.kind.assign(positions.size(), VertexKind::kFree);
  complex.anchor.assign(positions.size(), 0);
  complex.near_face.assign(positions.size(), -1);
  complex.positions = std::move(positions);

  std::vector<std::array<int, 3>> sides;  // lower vertex, higher vertex, dart
  sides.reserve(darts);
  for (int d = 0; d < darts; ++d)
    sides.push_back({std::min(complex.from(d), complex.to(d)), std::max(complex.from(d), complex.to(d)), d});
  bucket_sort(sides, [](const std::array<int, 3>& side) { return side[0]; }, std::less<>());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i + 1;
    while (j < sides.size() && sides[j][0] == sides[i][0] && sides[j][1] == sides[i][1]) ++j;
    if (j - i > 2) throw InternalError("quad complex", "a side belongs to more than two quads");
    if (j - i == 2) {
      const int d = sides[i][2], e = sides[i + 1][2];
      if (complex.from(d) != complex.to(e))
        throw InternalError("quad complex", "two quads run along a side in the same direction");
      complex.opposite[d] = e;
      complex.opposite[e] = d;
    }
    i = j;
  }
  return complex;
}

QuadComplex complex_of(const QuadMesh& mesh) {
  QuadComplex complex = complex_of_quads(mesh.positions, mesh.quads);
  complex.kind = mesh.kind;
  complex.anchor = mesh.anchor;
  complex.near_face = mesh.near_face;
  std::vector<std::pair<std::array<int, 2>, int>> curve_of;
  for (const QuadMesh::FeatureEdge& e : mesh.feature_edges) curve_of.push_back({{std::min(e.a, e.b), std::max(e.a, e.b)}, e.curve});
  std::sort(curve_of.begin(), curve_of.end());
  for (int d = 0; d < static_cast<int>(complex.opposite.size()); ++d) {
    const std::array<int, 2> ends{std::min(complex.from(d), complex.to(d)), std::max(complex.from(d), complex.to(d))};
    const auto at = std::lower_bound(curve_of.begin(), curve_of.end(), std::make_pair(ends, -1));
    if (at != curve_of.end() && at->first == ends) complex.curve[d] = at->second;
  }
  return complex;
}

std::vector<int> vertex_orbits(const std::vector<int>& opposite) {
  std::vector<int> orbit(opposite.size(), -1);
  int count = 0;
  for (int seed = 0; seed < static_cast<int>(opposite.size()); ++seed) {
    if (orbit[seed] >= 0) continue;
    int d = seed;
    while (d >= 0 && orbit[d] < 0) {  // counterclockwise
      orbit[d] = count;
      d = opposite[QuadComplex::previous(d)];
    }
    d = opposite[seed] < 0 ? -1 : QuadComplex::next(opposite[seed]);
    while (d >= 0 && orbit[d] < 0) {  // and, from a border, clockwise
      orbit[d] = count;
      d = opposite[d] < 0 ? -1 : QuadComplex::next(opposite[d]);
    }
    ++count;
  }
  return orbit;
}

int euler_characteristic(const QuadComplex& complex) {
  const std::vector<int> orbit = vertex_orbits(complex.opposite);
  const int vertices = orbit.empty() ? 0 : *std::max_element(orbit.begin(), orbit.end()) + 1;
  int border = 0;
  for (const int o : complex.opposite) border += o < 0;
  const int darts = static_cast<int>(complex.opposite.size());
  return vertices - (darts + border) / 2 + complex.quad_count();
}

int euler_characteristic(const QuadMesh& mesh) { return euler_characteristic(complex_of_quads(mesh.positions, mesh.quads)); }

namespace {

/// Where the arrays cannot even be read as a complex, the finer checks make no sense.
bool sizes_agree(const QuadComplex& c, std::vector<std::string>& found) {
  const std::size_t darts = c.opposite.size(), vertices = c.positions.size();
  if (darts % 4 != 0 || c.vertex.size() != darts || c.curve.size() != darts)
    found.push_back("dart arrays differ in length");
  if (c.kind.size() != vertices || c.anchor.size() != vertices || c.near_face.size() != vertices)
    found.push_back("vertex arrays differ in length");
  for (std::size_t d = 0; d < darts && found.empty(); ++d) {
    const int o = c.opposite[d], v = c.vertex[d];
    if (o < -1 || o >= static_cast<int>(darts))
      found.push_back("dart " + std::to_string(d) + " is glued to no dart");
    if (v < 0 || v >= static_cast<int>(vertices))
      found.push_back("dart " + std::to_string(d) + " starts at no vertex");
  }
  return found.empty();
}

void check_gluing(const QuadComplex& c, std::vector<std::string>& found) {
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d) {
    const int o = c.opposite[d];
    const auto report = [&](const char* what) { found.push_back("dart " + std::to_string(d) + what); };
    if (c.curve[d] >= 0 && (c.kind[c.from(d)] == VertexKind::kFree || c.kind[c.to(d)] == VertexKind::kFree))
      report(" lies on a curve but ends at a free vertex");
    if (o < 0) continue;
    if (o == d || c.opposite[o] != d) {
      report(": gluing is no involution");
      continue;
    }
    if (c.from(o) != c.to(d) || c.to(o) != c.from(d)) report(": its two sides disagree on the vertices");
    if (c.curve[o] != c.curve[d]) report(": its two sides disagree on the curve");
  }
}

void check_vertices(const QuadComplex& c, std::vector<std::string>& found) {
  const std::vector<int> orbit = vertex_orbits(c.opposite);
  std::vector<int> orbit_of(c.positions.size(), -1), vertex_of;
  for (std::size_t d = 0; d < orbit.size(); ++d) {
    const int v = c.vertex[d];
    if (orbit[d] == static_cast<int>(vertex_of.size())) {
      vertex_of.push_back(v);
      if (orbit_of[v] >= 0) found.push_back("vertex " + std::to_string(v) + " has more than one fan");
      orbit_of[v] = orbit[d];
    } else if (vertex_of[orbit[d]] != v) {
      found.push_back("dart " + std::to_string(d) + ": one fan has two vertex numbers");
    }
  }
  for (std::size_t v = 0; v < c.positions.size(); ++v) {
    if (orbit_of[v] < 0) found.push_back("vertex " + std::to_string(v) + " belongs to no quad");
    if (!c.positions[v].allFinite()) found.push_back("vertex " + std::to_string(v) + " is not finite");
  }
}

}  // namespace

std::vector<std::string> violations_of(const QuadComplex& complex) {
  std::vector<std::string> found;
  if (!sizes_agree(complex, found)) return found;
  check_gluing(complex, found);
  if (found.empty()) check_vertices(complex, found);
  return found;
}

QuadMesh to_quad_mesh(const QuadComplex& complex) {
  QuadMesh mesh;
  mesh.positions = complex.positions;
  mesh.kind = complex.kind;
  mesh.anchor = complex.anchor;
  mesh.near_face = complex.near_face;
  mesh.quads.reserve(complex.quad_count());
  for (int q = 0; q < complex.quad_count(); ++q) {
    const int* v = &complex.vertex[4 * q];
    mesh.quads.push_back({v[0], v[1], v[2], v[3]});
  }
  for (int d = 0; d < static_cast<int>(complex.opposite.size()); ++d)
    if (complex.curve[d] >= 0 && (complex.opposite[d] < 0 || d < complex.opposite[d]))
      mesh.feature_edges.push_back({complex.from(d), complex.to(d), complex.curve[d]});
  return mesh;
}

}  // namespace hybrid_quad
