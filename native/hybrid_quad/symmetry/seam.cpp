#include <algorithm>
#include <cmath>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/complex_editor.h"
#include "hybrid_quad/mesh/polychords.h"
#include "hybrid_quad/mesh/segment_index.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

namespace {

/// What of a part's quads the mirror planes see.
struct Seams {
  std::vector<PlaneSet> side;    ///< 4 #Q: planes in which the side lies
  std::vector<PlaneSet> vertex;  ///< #V: planes with a seam through or to the vertex
  std::vector<PlaneSet> inside;  ///< #V: planes with two seam sides at the vertex
};

Seams seams_of(const QuadComplex& complex, const std::vector<PlaneSet>& curve_planes) {
  Seams seams;
  const int darts = static_cast<int>(complex.opposite.size());
  seams.side.assign(darts, 0);
  seams.vertex.assign(complex.positions.size(), 0);
  seams.inside.assign(complex.positions.size(), 0);
  for (int d = 0; d < darts; ++d) {
    if (complex.opposite[d] >= 0 || complex.curve[d] < 0) continue;
    const PlaneSet planes = seams.side[d] = curve_planes[complex.curve[d]];
    // A border vertex begins one border side and ends another.
    for (const int v : {complex.from(d), complex.to(d)}) {
      seams.inside[v] |= seams.vertex[v] & planes;
      seams.vertex[v] |= planes;
    }
  }
  return seams;
}

/// Insets quads that are alone at a vertex inside a seam. \return how many
int inset_lone_quads(QuadComplex& complex, const std::vector<PlaneSet>& curve_planes) {
  const Seams seams = seams_of(complex, curve_planes);
  const std::vector<int> region = quad_regions(complex);
  ComplexEditor editor(complex);
  const int quads = complex.quad_count();
  int count = 0;
  for (int q = 0; q < quads; ++q)
    for (int d = 4 * q; d < 4 * q + 4; ++d)
      if (seams.inside[complex.from(d)] && editor.corner_count(complex.from(d)) == 1) {
        editor.inset(q, region[q]);
        ++count;
        break;
      }
  editor.compact();
  return count;
}

/// Splits the strips of all sides that lead from seam to seam of a plane without being part of one. \return how many
int split_rungs(QuadComplex& complex, const std::vector<PlaneSet>& curve_planes) {
  const Seams seams = seams_of(complex, curve_planes);
  const Polychords polychords = trace_polychords(complex);
  std::vector<char> chosen(polychords.length.size(), 0);
  for (int d = 0; d < static_cast<int>(complex.opposite.size()); ++d) {
    const PlaneSet both = seams.vertex[complex.from(d)] & seams.vertex[complex.to(d)];
    if ((both & ~seams.side[d]) != 0) chosen[polychords.of_dart[d]] = 1;
  }
  const int count = static_cast<int>(std::count(chosen.begin(), chosen.end(), 1));
  if (count > 0) complex = split_polychords(complex, polychords, chosen);
  return count;
}

}  // namespace

PlaneSet planes_of_edge(const TriangleMesh& mesh, int h, PlaneSet planes) {
  PlaneSet in = 0;
  if (!mesh.is_boundary(h)) return in;
  for (int axis = 0; axis < 3; ++axis)
    if (has_plane(planes, axis) && mesh.position(mesh.from(h))[axis] == 0 && mesh.position(mesh.to(h))[axis] == 0)
      in |= plane(axis);
  return in;
}

std::vector<int> seam_ends(const TriangleMesh& mesh, PlaneSet planes) {
  std::vector<PlaneSet> after(mesh.vertex_count(), 0), before(mesh.vertex_count(), 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h) after[mesh.from(h)] |= planes_of_edge(mesh, h, planes);
  for (int h = 0; h < mesh.halfedge_count(); ++h) before[mesh.to(h)] |= planes_of_edge(mesh, h, planes);
  std::vector<int> ends;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (before[v] != after[v]) ends.push_back(v);
  return ends;
}

std::vector<PlaneSet> seam_planes(const TriangleMesh& mesh, const FeatureGraph& features, PlaneSet planes) {
  std::vector<PlaneSet> of_curve(features.curves.size(), 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.is_boundary(h)) of_curve[features.halfedge_curve[h]] = planes_of_edge(mesh, h, planes);
  return of_curve;
}

int open_seams(QuadComplex& complex, const std::vector<PlaneSet>& curve_planes) {
  constexpr int kMostRounds = 10;
  if (std::all_of(curve_planes.begin(), curve_planes.end(), [](PlaneSet planes) { return planes == 0; })) return 0;
  int changes = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    // One after the other: an inset gives the quads between two rungs new sides.
    const int inset = inset_lone_quads(complex, curve_planes);
    const int split = split_rungs(complex, curve_planes);
    changes += inset + split;
    if (inset + split == 0) return changes;
  }
  throw InternalError("symmetry", "a seam could not be opened");
}

int open_seams(QuadMesh& mesh, const std::vector<PlaneSet>& curve_planes) {
  QuadComplex complex = complex_of(mesh);
  const int changes = open_seams(complex, curve_planes);
  if (changes > 0) mesh = to_quad_mesh(complex);
  return changes;
}

std::vector<char> seam_creases(const QuadMesh& part, const std::vector<PlaneSet>& curve_planes, const TriangleMesh& mesh,
                               PlaneSet planes, double sharp_angle, const std::vector<std::array<int, 2>>& marked) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  std::vector<std::array<int, 2>> sorted;
  for (const auto& m : marked) sorted.push_back({std::min(m[0], m[1]), std::max(m[0], m[1])});
  std::sort(sorted.begin(), sorted.end());
  // All seam edges of the part, and whether the mirrored surface is sharp there.
  std::vector<std::array<Vector3, 2>> segments;
  std::vector<char> is_sharp;
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const PlaneSet in = planes_of_edge(mesh, h, planes);
    if (in == 0) continue;
    const int a = mesh.from(h), b = mesh.to(h);
    bool sharp = std::binary_search(sorted.begin(), sorted.end(), std::array<int, 2>{std::min(a, b), std::max(a, b)});
    for (int axis = 0; axis < 3; ++axis)
      if (has_plane(in, axis)) {
        // Between a face and its image: twice the angle between the face and the plane's normal direction.
        const double bend = 2 * std::asin(std::min(1.0, std::abs(mesh.normal(h / 3)[axis])));
        sharp |= bend > sharp_angle * kDegree;
      }
    segments.push_back({mesh.position(a), mesh.position(b)});
    is_sharp.push_back(sharp);
  }
  std::vector<char> creases(part.feature_edges.size(), 0);
  if (segments.empty()) return creases;
  const SegmentIndex index(std::move(segments));
  for (std::size_t e = 0; e < creases.size(); ++e) {
    const QuadMesh::FeatureEdge& edge = part.feature_edges[e];
    if (curve_planes[edge.curve] == 0) continue;
    const Vector3 middle = 0.5 * (part.positions[edge.a] + part.positions[edge.b]);
    creases[e] = is_sharp[index.nearest(middle).segment];
  }
  return creases;
}

}  // namespace hybrid_quad
