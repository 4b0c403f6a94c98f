#include "hybrid_quad/pipeline/snapshots.h"

namespace hybrid_quad {

namespace {

const std::string kTargetLength = "target length";

Snapshot triangles_snapshot(const TriangleMesh& mesh, const std::string& stage) {
  Snapshot s;
  s.stage = stage;
  s.points = mesh.positions();
  s.face_sizes.assign(mesh.face_count(), 3);
  for (const auto& face : mesh.faces()) s.face_vertices.insert(s.face_vertices.end(), face.begin(), face.end());
  return s;
}

Snapshot surface_snapshot(const TriangleMesh& mesh, const FeatureGraph& features, const std::string& stage) {
  Snapshot s = triangles_snapshot(mesh, stage);
  for (const FeatureCurve& curve : features.curves)
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i) s.lines.push_back({curve.vertices[i], curve.vertices[i + 1]});
  s.vertex_values["corner"].assign(features.is_corner.begin(), features.is_corner.end());
  s.face_values["region"].assign(features.face_region.begin(), features.face_region.end());
  return s;
}

void add_vectors(Snapshot& s, const std::string& name, const std::vector<Vector3>& rows) {
  auto& out = s.face_vectors[name];
  for (const Vector3& r : rows) out.insert(out.end(), r.data(), r.data() + 3);
}

}  // namespace

Snapshot snapshot_of(const TriangleMesh& mesh) {
  Snapshot s = triangles_snapshot(mesh, "mesh");
  for (int side = 0; side < 3; ++side) {
    auto& values = s.face_values["opposite of side " + std::to_string(side)];
    for (int f = 0; f < mesh.face_count(); ++f) values.push_back(mesh.opposite(3 * f + side));
  }
  return s;
}

Snapshot snapshot_of(const TriangleMesh& mesh, const FeatureGraph& features) {
  return surface_snapshot(mesh, features, "features");
}

Snapshot snapshot_of(const WorkingSurface& surface) {
  Snapshot s = surface_snapshot(surface.mesh, surface.features, "working surface");
  s.face_values[kTargetLength] = surface.target_length;
  return s;
}

Snapshot snapshot_of(const FrameField& field, const WorkingSurface& surface, const std::string& stage) {
  Snapshot s = surface_snapshot(surface.mesh, surface.features, stage);
  add_vectors(s, "u direction", field.du);
  add_vectors(s, "v direction", field.dv);
  s.vertex_values["cone index"].assign(field.cone_index.begin(), field.cone_index.end());
  return s;
}

Snapshot snapshot_of(const PeriodicField& psi, const WorkingSurface& surface) {
  Snapshot s = surface_snapshot(surface.mesh, surface.features, "periodic field");
  for (const PhasePair& z : psi.psi) s.vertex_values["morse"].push_back(z.morse());
  return s;
}

Snapshot snapshot_of(const SpanningParameterization& param, const WorkingSurface& surface) {
  Snapshot s = surface_snapshot(surface.mesh, surface.features, "spanning parameterization");
  s.face_values["regular"].assign(param.is_regular.begin(), param.is_regular.end());
  for (const auto& c : param.charge) s.face_values["charge"].push_back(c[0] != 0 || c[1] != 0);
  return s;
}

Snapshot snapshot_of(const RegularQuads& regular, const SingularPatches& singular) {
  const GridOverlay& overlay = regular.overlay;
  Snapshot s;
  s.stage = "regular quads";
  for (const auto& v : overlay.vertices) {
    s.points.push_back(v.position);
    s.vertex_values["grid sign"].push_back(v.grid_sign);
  }
  for (int p = 0; p < overlay.piece_count(); ++p) s.face_sizes.push_back(overlay.piece_begin[p + 1] - overlay.piece_begin[p]);
  s.face_vertices = overlay.origin;
  s.face_values["quad"].assign(regular.piece_cell.begin(), regular.piece_cell.end());
  s.face_values["patch"].assign(singular.piece_patch.begin(), singular.piece_patch.end());
  for (int k = 0; k < static_cast<int>(overlay.origin.size()); ++k)
    if (overlay.curve[k] >= 0) s.lines.push_back({overlay.origin[k], overlay.target(k)});
  return s;
}

Snapshot snapshot_of(const QuadMesh& quads, const std::string& stage) {
  Snapshot s;
  s.stage = stage;
  s.points = quads.positions;
  s.face_sizes.assign(quads.quads.size(), 4);
  for (const auto& q : quads.quads) s.face_vertices.insert(s.face_vertices.end(), q.begin(), q.end());
  for (const VertexKind k : quads.kind) s.vertex_values["kind"].push_back(static_cast<double>(k));
  for (const auto& e : quads.feature_edges) s.lines.push_back({e.a, e.b});
  return s;
}

Snapshot in_scene(Snapshot snapshot, const UnitFrame& frame) {
  for (Vector3& p : snapshot.points) p = frame.outward(p);
  const auto lengths = snapshot.face_values.find(kTargetLength);
  if (lengths != snapshot.face_values.end())
    for (double& length : lengths->second) length *= frame.scale;
  return snapshot;
}

}  // namespace hybrid_quad
