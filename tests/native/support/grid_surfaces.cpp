#include "support/grid_surfaces.h"

#include <cmath>
#include <utility>

#include "hybrid_quad/grid_algebra/quarter_turn.h"

namespace hybrid_quad::test {

namespace {

/// The gradient of the linear function with these differences along the face's first two edges.
Vector3 gradient(const TriangleMesh& mesh, int f, double along0, double along1) {
  const Vector3 a = mesh.edge_vector(3 * f), b = mesh.edge_vector(3 * f + 1), n = mesh.area_normal(f);
  return (along0 * b.cross(n) + along1 * n.cross(a)) / n.squaredNorm();
}

double wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }

}  // namespace

WorkingSurface surface_of(TriangleMesh mesh, double h, double sharp_angle) {
  WorkingSurface surface;
  surface.mesh = std::move(mesh);
  FeatureOptions options;
  options.sharp_angle = sharp_angle;
  surface.features = detect_features(surface.mesh, options, RunContext{});
  surface.input_vertex.resize(surface.mesh.vertex_count());
  surface.near_face.resize(surface.mesh.vertex_count());
  for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
    surface.input_vertex[v] = v;
    surface.near_face[v] = surface.mesh.outgoing(v) / 3;
  }
  surface.target_length.assign(surface.mesh.face_count(), h);
  return surface;
}

FrameField constant_frames(const WorkingSurface& surface, const Vector3& du, const Vector3& dv) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<Vector3> rows_u, rows_v;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const Vector3 n = mesh.normal(f);
    rows_u.push_back(du - n * n.dot(du));
    rows_v.push_back(dv - n * n.dot(dv));
  }
  return frame_field_from_rows(surface, FaceAngles(surface.mesh), rows_u, rows_v);
}

FrameField torus_frames(const WorkingSurface& surface, double around, double along, double major) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<Vector3> rows_u, rows_v;
  const auto axis_angle = [&](int v) { return std::atan2(mesh.position(v)[1], mesh.position(v)[0]); };
  const auto tube_angle = [&](int v) {
    return std::atan2(mesh.position(v)[2], mesh.position(v).head<2>().norm() - major);
  };
  for (int f = 0; f < mesh.face_count(); ++f) {
    double d[2][2];
    for (int i = 0; i < 2; ++i) {
      const int p = mesh.from(3 * f + i), q = mesh.to(3 * f + i);
      d[0][i] = around / (2 * M_PI) * wrapped(axis_angle(q) - axis_angle(p));
      d[1][i] = along / (2 * M_PI) * wrapped(tube_angle(q) - tube_angle(p));
    }
    Vector3 du = gradient(mesh, f, d[0][0], d[0][1]), dv = gradient(mesh, f, d[1][0], d[1][1]);
    if (du.cross(dv).dot(mesh.area_normal(f)) < 0) dv = -dv;
    rows_u.push_back(du);
    rows_v.push_back(dv);
  }
  return frame_field_from_rows(surface, FaceAngles(surface.mesh), rows_u, rows_v);
}

FrameField smooth_frames(const WorkingSurface& surface, double h) {
  FrameField frames = solve_frame_field(surface, FrameFieldOptions{}, RunContext{});
  for (Vector3& d : frames.du) d /= h;
  for (Vector3& d : frames.dv) d /= h;
  return frames;
}

FrameField turned_frames(const WorkingSurface& surface, const FrameField& frames,
                         const std::vector<int>& turns) {
  FrameField result = frames;
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    const Vector3 du = frames.du[f], dv = frames.dv[f];
    for (int i = 0; i < 3; ++i) {
      const Vector2 row = turned(Vector2(du[i], dv[i]), turns[f]);
      result.du[f][i] = row[0];
      result.dv[f][i] = row[1];
    }
  }
  for (int h = 0; h < surface.mesh.halfedge_count(); ++h) {
    const int o = surface.mesh.opposite(h);
    if (o >= 0)
      result.matching[h] =
          static_cast<std::uint8_t>(wrap_turns(frames.matching[h] + turns[o / 3] - turns[h / 3]));
  }
  return result;
}

}  // namespace hybrid_quad::test
