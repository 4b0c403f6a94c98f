#include <algorithm>
#include <string>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

namespace {

/// A mesh on its way through the planes: what lies on the seams of those still to come.
struct Mirrored {
  QuadMesh mesh;
  std::vector<PlaneSet> vertex_planes;  ///< #V
  std::vector<PlaneSet> edge_planes;    ///< #feature_edges
  std::vector<char> is_feature;         ///< #feature_edges: also of the whole
};

Mirrored with_seams(const QuadMesh& part, const std::vector<PlaneSet>& curve_planes, const std::vector<char>& is_crease) {
  Mirrored m{part, std::vector<PlaneSet>(part.positions.size(), 0), {}, {}};
  for (std::size_t i = 0; i < part.feature_edges.size(); ++i) {
    const QuadMesh::FeatureEdge& e = part.feature_edges[i];
    const PlaneSet planes = curve_planes[e.curve];
    m.edge_planes.push_back(planes);
    m.is_feature.push_back(planes == 0 || is_crease[i]);
    for (const int v : {e.a, e.b}) m.vertex_planes[v] |= planes;
  }
  // A seam vertex lies between seam points of the input, all of which have coordinate zero.
  for (std::size_t v = 0; v < part.positions.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      if (has_plane(m.vertex_planes[v], axis)) {
        if (part.positions[v][axis] != 0) throw InternalError("symmetry", "vertex " + std::to_string(v) + " is off its seam");
        m.mesh.positions[v][axis] = 0.0;  // without a sign
      }
  return m;
}

/// Adds the image at one plane.
void add_image(Mirrored& m, int axis, int curve_count) {
  QuadMesh& mesh = m.mesh;
  const int vertices = static_cast<int>(mesh.positions.size());
  std::vector<int> image(vertices);
  for (int v = 0; v < vertices; ++v) {
    if (has_plane(m.vertex_planes[v], axis)) {
      image[v] = v;
      continue;
    }
    image[v] = static_cast<int>(mesh.positions.size());
    Vector3 p = mesh.positions[v];
    p[axis] = -p[axis];
    mesh.positions.push_back(p);
    mesh.kind.push_back(mesh.kind[v]);
    mesh.anchor.push_back(mesh.kind[v] == VertexKind::kCorner ? -1 : mesh.anchor[v]);
    mesh.near_face.push_back(-1);
    m.vertex_planes.push_back(m.vertex_planes[v]);
  }
  for (std::size_t q = 0, count = mesh.quads.size(); q < count; ++q) {
    const auto& v = mesh.quads[q];
    mesh.quads.push_back({image[v[0]], image[v[3]], image[v[2]], image[v[1]]});
  }
  for (std::size_t i = 0, count = mesh.feature_edges.size(); i < count; ++i) {
    if (has_plane(m.edge_planes[i], axis)) continue;
    const QuadMesh::FeatureEdge e = mesh.feature_edges[i];
    mesh.feature_edges.push_back({image[e.a], image[e.b], e.curve + curve_count});
    m.edge_planes.push_back(m.edge_planes[i]);
    m.is_feature.push_back(m.is_feature[i]);
  }
}

/// Seams that only the mirroring made are no features of the whole.
QuadMesh without_smooth_seams(Mirrored m) {
  std::vector<QuadMesh::FeatureEdge> kept;
  std::vector<char> on_feature(m.mesh.positions.size(), 0);
  for (std::size_t i = 0; i < m.mesh.feature_edges.size(); ++i)
    if (m.is_feature[i]) {
      kept.push_back(m.mesh.feature_edges[i]);
      on_feature[kept.back().a] = on_feature[kept.back().b] = 1;
    }
  m.mesh.feature_edges = std::move(kept);
  for (std::size_t v = 0; v < on_feature.size(); ++v)
    if (m.vertex_planes[v] != 0 && !on_feature[v]) {
      m.mesh.kind[v] = VertexKind::kFree;
      m.mesh.anchor[v] = -1;
    }
  return std::move(m.mesh);
}

}  // namespace

QuadMesh mirror_quads(const QuadMesh& part, const std::vector<PlaneSet>& curve_planes, PlaneSet planes,
                      const std::vector<char>& is_crease) {
  Mirrored m = with_seams(part, curve_planes, is_crease);
  int curves = static_cast<int>(curve_planes.size());
  for (int axis = 0; axis < 3; ++axis) {
    if (!has_plane(planes, axis)) continue;
    add_image(m, axis, curves);
    curves *= 2;
  }
  return without_smooth_seams(std::move(m));
}

}  // namespace hybrid_quad
