#include <algorithm>
#include <cmath>
#include <utility>

#include "hybrid_quad/mesh/quad_complex.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/singular_patches/disk_fill.h"
#include "hybrid_quad/singular_patches/patch_border.h"
#include "hybrid_quad/singular_patches/patch_quads.h"
#include "hybrid_quad/singular_patches/triangle_coarsening.h"

namespace hybrid_quad {

namespace {

constexpr std::size_t kMostPolygonCorners = 16;  // fill_disk grows with a high power of it
constexpr double kWorstCostOfAQuad = 3.0;   // of a directly filled disk; beyond it lies a fold or a huge quad
constexpr double kMostQuadsForShape = 8.0;  // times the wanted number: then size goes before shape

/// Unit normal of the surface at vertex v.
Vector3 vertex_normal(const TriangleMesh& mesh, int v) {
  Vector3 sum = Vector3::Zero();
  for (int h = mesh.outgoing(v), first = h; h >= 0;) {
    sum += mesh.area_normal(mesh.face_of(h));
    h = mesh.rotate_ccw(h);
    if (h == first) break;
  }
  const double length = sum.norm();
  return length > 0 ? Vector3(sum / length) : Vector3(0, 0, 1);
}

/// Whether a patch is a disk (one piece, one border loop) with few enough arcs for a direct fill.
bool is_small_disk(const PatchSurface& patch, const PatchBorder& border) {
  return border.size() == 1 && border[0].size() <= kMostPolygonCorners &&
         patch.mesh.euler_characteristic() == 1;
}

/// A disk as few quads with its nodes as corners. \return no quads where they would be bad: folded, or far
/// too large
PatchQuads fill_small_disk(const PatchSurface& patch, const std::vector<PatchArc>& loop) {
  BorderPolygon polygon;
  double perimeter = 0;
  for (const PatchArc& arc : loop) {
    polygon.positions.push_back(patch.mesh.position(arc.from));
    polygon.normals.push_back(vertex_normal(patch.mesh, arc.from));
    perimeter += (patch.mesh.position(arc.to) - patch.mesh.position(arc.from)).norm();
  }
  const int corners = static_cast<int>(loop.size());
  polygon.target_length = patch.target_length > 0 ? patch.target_length : perimeter / corners;
  const DiskFill fill = fill_disk(polygon);
  PatchQuads result;
  const double quads = static_cast<double>(fill.quads.size()),
               unit = polygon.target_length * polygon.target_length;
  if (fill.cost > kWorstCostOfAQuad * quads || patch.mesh.total_area() > 3 * quads * unit) return result;

  QuadComplex complex = complex_of_quads(fill.positions, fill.quads);
  result.positions = fill.positions;
  result.quads = fill.quads;
  result.opposite = std::move(complex.opposite);
  result.arc.assign(result.opposite.size(), -1);
  result.node.assign(result.positions.size(), -1);
  for (int i = 0; i < corners; ++i) result.node[i] = patch.node[loop[i].from];
  for (int d = 0; d < static_cast<int>(result.opposite.size()); ++d)
    if (result.opposite[d] < 0) result.arc[d] = loop[complex.vertex[d]].id;
  return result;
}

/// Every triangle becomes three quads around its centroid. Vertices: the triangles' corners, then edges, then
/// centroids.
PatchQuads split_into_quads(const CoarseTriangles& triangles, const PatchSurface& patch) {
  const int faces = triangles.face_count(), sides = 3 * faces;
  PatchQuads result;
  result.positions = triangles.positions();
  for (std::size_t v = 0; v < result.positions.size(); ++v) {
    const int border = triangles.border_vertex(static_cast<int>(v));
    result.node.push_back(border < 0 ? -1 : patch.node[border]);
  }
  std::vector<int> middle(sides, -1);
  for (int h = 0; h < sides; ++h) {
    const int o = triangles.opposite(h);
    if (o >= 0 && o < h) {
      middle[h] = middle[o];
      continue;
    }
    middle[h] = static_cast<int>(result.positions.size());
    const int passed = triangles.passed_node(h);
    const int vertex = passed < 0 ? -1 : triangles.passed_nodes()[passed].vertex;
    const auto& p = triangles.positions();
    result.positions.push_back(vertex < 0 ? Vector3(0.5 * (p[triangles.from(h)] + p[triangles.to(h)]))
                                          : patch.mesh.position(vertex));
    result.node.push_back(vertex < 0 ? -1 : patch.node[vertex]);
  }
  result.opposite.assign(4 * sides, -1);
  result.arc.assign(4 * sides, -1);
  // The quad at the origin of side h has number h: origin, middle of h, centroid, middle of the side before.
  for (int f = 0; f < faces; ++f) {
    const int centroid = static_cast<int>(result.positions.size());
    Vector3 sum = Vector3::Zero();
    for (int h = 3 * f; h < 3 * f + 3; ++h) sum += result.positions[middle[h]];
    result.positions.push_back(sum / 3.0);
    result.node.push_back(-1);
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int after = TriangleMesh::next(h), before = TriangleMesh::previous(h), o = triangles.opposite(h);
      result.quads.push_back({triangles.from(h), middle[h], centroid, middle[before]});
      result.opposite[4 * h + 1] = 4 * after + 2;
      result.opposite[4 * after + 2] = 4 * h + 1;
      if (o >= 0) {
        result.opposite[4 * h] = 4 * TriangleMesh::next(o) + 3;
        result.opposite[4 * TriangleMesh::next(o) + 3] = 4 * h;
      } else {
        const CoarseTriangles::PassedNode& passed = triangles.passed_nodes()[triangles.passed_node(h)];
        result.arc[4 * h] = passed.arc_before;
        result.arc[4 * after + 3] = passed.arc_after;
      }
    }
  }
  return result;
}

/// Vertices inside the patch onto its surface.
void move_to_surface(PatchQuads& quads, const SurfaceIndex& surface) {
  for (std::size_t v = 0; v < quads.positions.size(); ++v)
    if (quads.node[v] < 0) quads.positions[v] = surface.nearest(quads.positions[v]).position;
}

}  // namespace

PatchQuads combinatorial_fill(const PatchSurface& patch, const RunContext& context) {
  const PatchBorder border = border_of(patch);
  const SurfaceIndex surface(patch.mesh, {});
  if (is_small_disk(patch, border)) {
    PatchQuads quads = fill_small_disk(patch, border[0]);
    if (!quads.quads.empty()) {
      move_to_surface(quads, surface);
      return quads;
    }
  }
  context.checkpoint();
  // Three quads a triangle of edge length l: each has 0.14 l^2. Collapses up to a length leave edges of 1 to
  // 2 times it.
  const double h = patch.target_length > 0 ? patch.target_length : 4 * patch.mesh.mean_edge_length();
  CoarseTriangles triangles(patch, border);
  triangles.coarsen(1.5 * h, true, context);
  const double wanted = patch.mesh.total_area() / (h * h);
  if (3 * triangles.alive_count() >
      kMostQuadsForShape * (wanted + static_cast<double>(triangles.passed_nodes().size())))
    triangles.coarsen(h, false, context);
  triangles.flip_towards_six();
  triangles.smooth(surface, 3);
  triangles.flip_towards_six();
  triangles.smooth(surface, 3);
  triangles.raise_low_valences();
  triangles.compact();
  PatchQuads quads = split_into_quads(triangles, patch);
  move_to_surface(quads, surface);
  return quads;
}

}  // namespace hybrid_quad
