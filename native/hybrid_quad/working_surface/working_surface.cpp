#include "hybrid_quad/working_surface/working_surface.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "hybrid_quad/mesh/topology.h"
#include "hybrid_quad/working_surface/surface_remesher.h"
#include "hybrid_quad/working_surface/transferred_features.h"

namespace hybrid_quad {

WorkingSurface build_working_surface(const TriangleMesh& input, const FeatureGraph& features,
                                     const std::vector<double>& target_length, const WorkingSurfaceOptions& options,
                                     const RunContext& context) {
  return build_working_surface(SurfaceIndex(input, features.face_region), features, target_length, options, context);
}

WorkingSurface build_working_surface(const SurfaceIndex& index, const FeatureGraph& features,
                                     const std::vector<double>& target_length, const WorkingSurfaceOptions& options,
                                     const RunContext& context) {
  const TriangleMesh& input = index.mesh();
  if (static_cast<int>(target_length.size()) != input.vertex_count())
    throw InternalError("working_surface", "one target length a vertex is needed");
  for (int v = 0; v < input.vertex_count(); ++v)
    if (input.outgoing(v) >= 0 && !(target_length[v] > 0))
      throw InternalError("working_surface", "target lengths must be positive");
  SurfaceRemesher remesher(index, features, target_length, options, context);
  remesher.run();

  EditableMesh::Compacted compacted = remesher.mesh().compacted();
  WorkingSurface surface;
  surface.mesh = std::move(compacted.mesh);
  std::vector<double> vertex_target;
  for (const int slot : compacted.vertex_slot) {
    surface.input_vertex.push_back(remesher.input_vertex(slot));
    surface.near_face.push_back(remesher.near_face(slot));
    vertex_target.push_back(remesher.target_length(slot));
  }
  for (const auto& t : surface.mesh.faces())
    surface.target_length.push_back((vertex_target[t[0]] + vertex_target[t[1]] + vertex_target[t[2]]) / 3);
  surface.features = transferred_features(surface.mesh, std::move(compacted.halfedge_curve), std::move(compacted.face_region),
                                          surface.input_vertex, features);
  return surface;
}

namespace {

void check_curves(const WorkingSurface& surface, const FeatureGraph& features, std::vector<std::string>& found) {
  const FeatureGraph& g = surface.features;
  if (g.curves.size() != features.curves.size()) {
    found.push_back("the number of curves changed");
    return;
  }
  const auto input_of = [&surface](int v) { return surface.input_vertex[v]; };
  for (std::size_t c = 0; c < g.curves.size(); ++c) {
    const FeatureCurve &now = g.curves[c], &before = features.curves[c];
    const std::string name = "curve " + std::to_string(c);
    if (now.closed != before.closed || now.boundary != before.boundary) found.push_back(name + " changed its kind");
    if (!before.closed && (input_of(now.vertices.front()) != before.vertices.front() ||
                           input_of(now.vertices.back()) != before.vertices.back()))
      found.push_back(name + " changed its ends");
    const bool loop = now.vertices.front() == now.vertices.back();
    if (now.vertices.size() < (loop ? 5u : 3u)) found.push_back(name + " has too few edges");
  }
  const auto corner_count = [](const FeatureGraph& f) { return std::count(f.is_corner.begin(), f.is_corner.end(), 1); };
  if (corner_count(g) != corner_count(features)) found.push_back("the number of corners changed");
  const auto region_count = [](const FeatureGraph& f) {
    return f.face_region.empty() ? -1 : *std::max_element(f.face_region.begin(), f.face_region.end());
  };
  if (region_count(g) != region_count(features)) found.push_back("the number of regions changed");
}

}  // namespace

std::vector<std::string> violations_of(const WorkingSurface& surface, const TriangleMesh& input, const FeatureGraph& features) {
  std::vector<std::string> found = violations_of(surface.features, surface.mesh);
  if (!found.empty()) return found;
  const TriangleMesh& m = surface.mesh;
  if (m.euler_characteristic() != input.euler_characteristic() || border_loops_of(m) != border_loops_of(input))
    found.push_back("the topology changed");
  if (static_cast<int>(surface.input_vertex.size()) != m.vertex_count()) found.push_back("input_vertex has a wrong size");
  if (static_cast<int>(surface.near_face.size()) != m.vertex_count()) found.push_back("near_face has a wrong size");
  if (static_cast<int>(surface.target_length.size()) != m.face_count()) found.push_back("target_length has a wrong size");
  for (int f = 0; f < m.face_count(); ++f)
    if (!(m.area_normal(f).norm() > 0)) found.push_back("face " + std::to_string(f) + " has no area");
  for (int h = 0; h < m.halfedge_count(); ++h)
    if (!surface.features.is_feature(h) && surface.features.on_feature[m.from(h)] && surface.features.on_feature[m.to(h)])
      found.push_back("half-edge " + std::to_string(h) + " joins two feature vertices");
  check_curves(surface, features, found);
  return found;
}

}  // namespace hybrid_quad
