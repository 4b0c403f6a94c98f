#include "hybrid_quad/singular_patches/patch_quads.h"

#include <algorithm>

#include "hybrid_quad/mesh/topology.h"

namespace hybrid_quad {

namespace {

QuadComplex as_complex(const PatchQuads& quads) {
  QuadComplex c;
  c.opposite = quads.opposite;
  c.curve.assign(quads.opposite.size(), -1);
  for (const auto& q : quads.quads) c.vertex.insert(c.vertex.end(), q.begin(), q.end());
  c.positions = quads.positions;
  c.kind.assign(quads.positions.size(), VertexKind::kFree);
  c.anchor.assign(quads.positions.size(), -1);
  c.near_face.assign(quads.positions.size(), -1);
  return c;
}

/// Arc ids of the patch's border half-edges in border order, one entry an arc, with the nodes at its ends.
struct ArcEnds {
  int arc, from, to, next_arc;
  bool operator<(const ArcEnds& o) const { return arc < o.arc; }
  bool operator==(const ArcEnds& o) const {
    return arc == o.arc && from == o.from && to == o.to && next_arc == o.next_arc;
  }
};

std::vector<ArcEnds> arcs_of(const PatchSurface& patch) {
  std::vector<ArcEnds> ends;
  const TriangleMesh& mesh = patch.mesh;
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h) || patch.node[mesh.from(h)] < 0) continue;
    int last = h;
    for (int steps = 0; patch.node[mesh.to(last)] < 0 && steps < mesh.halfedge_count(); ++steps)
      last = mesh.outgoing(mesh.to(last));
    ends.push_back({patch.boundary_arc[h], patch.node[mesh.from(h)], patch.node[mesh.to(last)],
                    patch.boundary_arc[mesh.outgoing(mesh.to(last))]});
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

std::vector<ArcEnds> arcs_of(const PatchQuads& quads, const QuadComplex& c) {
  std::vector<ArcEnds> ends;
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d) {
    if (c.opposite[d] >= 0) continue;
    int after = QuadComplex::next(d);
    while (c.opposite[after] >= 0) after = QuadComplex::next(c.opposite[after]);
    ends.push_back({quads.arc[d], quads.node[c.from(d)], quads.node[c.to(d)], quads.arc[after]});
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

void check_shapes(const PatchQuads& quads, const QuadComplex& c, std::vector<std::string>& found) {
  std::vector<int> valence(c.positions.size(), 0);
  std::vector<char> border(c.positions.size(), 0);
  std::vector<std::pair<int, int>> neighbours;
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d) {
    ++valence[c.from(d)];
    if (c.opposite[d] < 0)
      border[c.from(d)] = border[c.to(d)] = 1;
    else if (d < c.opposite[d])
      neighbours.emplace_back(std::min(d, c.opposite[d]) / 4, std::max(d, c.opposite[d]) / 4);
  }
  for (std::size_t v = 0; v < valence.size(); ++v) {
    if (!border[v] && valence[v] < 3)
      found.push_back("inner vertex " + std::to_string(v) + " has " + std::to_string(valence[v]) + " faces");
  }
  for (std::size_t q = 0; q < quads.quads.size(); ++q) {
    std::array<int, 4> v = quads.quads[q];
    std::sort(v.begin(), v.end());
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[3])
      found.push_back("quad " + std::to_string(q) + " repeats a vertex");
  }
  std::sort(neighbours.begin(), neighbours.end());
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    if (neighbours[i].first == neighbours[i].second || (i > 0 && neighbours[i] == neighbours[i - 1]))
      found.push_back("quads " + std::to_string(neighbours[i].first) + " and " +
                      std::to_string(neighbours[i].second) + " have two common edges");
}

}  // namespace

std::vector<std::string> structural_violations_of(const PatchQuads& quads, const PatchSurface& patch) {
  const std::size_t darts = 4 * quads.quads.size();
  if (quads.opposite.size() != darts || quads.arc.size() != darts ||
      quads.node.size() != quads.positions.size())
    return {"arrays differ in length"};
  if (darts == 0) return {"no quads"};
  const QuadComplex c = as_complex(quads);
  std::vector<std::string> found = violations_of(c);
  if (!found.empty()) return found;

  std::vector<char> on_border(c.positions.size(), 0);
  for (std::size_t d = 0; d < darts; ++d) {
    if (quads.opposite[d] < 0) on_border[c.vertex[d]] = 1;
    if ((quads.opposite[d] < 0) != (quads.arc[d] >= 0))
      found.push_back("dart " + std::to_string(d) + ": arcs and border disagree");
  }
  for (std::size_t v = 0; v < on_border.size(); ++v)
    if ((quads.node[v] >= 0) != (on_border[v] != 0))
      found.push_back("vertex " + std::to_string(v) + ": nodes and border disagree");
  if (arcs_of(patch) != arcs_of(quads, c)) found.push_back("the border is not the patch's");
  const Topology topology = topology_of(c), wanted = topology_of(patch.mesh);
  if (topology.euler_characteristic != wanted.euler_characteristic)
    found.push_back("Euler characteristic " + std::to_string(topology.euler_characteristic) + ", not the patch's " +
                    std::to_string(wanted.euler_characteristic));
  if (topology.pieces != wanted.pieces) found.push_back("not as many pieces as the patch");
  return found;
}

std::vector<std::string> violations_of(const PatchQuads& quads, const PatchSurface& patch) {
  std::vector<std::string> found = structural_violations_of(quads, patch);
  if (found.empty()) check_shapes(quads, as_complex(quads), found);
  return found;
}

}  // namespace hybrid_quad
