#include "hybrid_quad/frame_field/frame_field.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/frame_field/frame_topology.h"
#include "hybrid_quad/grid_algebra/quarter_turn.h"

namespace hybrid_quad {

namespace {

/// Turns that make every matching 0 along a breadth-first tree of the faces, component by component.
std::vector<int> combing_turns(const TriangleMesh& mesh, const std::vector<std::uint8_t>& matching) {
  std::vector<int> turns(mesh.face_count(), -1), queue;
  queue.reserve(mesh.face_count());
  for (int seed = 0; seed < mesh.face_count(); ++seed) {
    if (turns[seed] >= 0) continue;
    turns[seed] = 0;
    std::size_t head = queue.size();
    queue.push_back(seed);
    for (; head < queue.size(); ++head)
      for (int h = 3 * queue[head]; h < 3 * queue[head] + 3; ++h) {
        const int o = mesh.opposite(h);
        if (o < 0 || turns[o / 3] >= 0) continue;
        turns[o / 3] = wrap_turns(turns[h / 3] + inverse_turns(matching[h]));
        queue.push_back(o / 3);
      }
  }
  return turns;
}

/// Rows of a frame, turned as values are.
void turn_rows(Vector3& du, Vector3& dv, int k) {
  const Vector3 u = du, v = dv;
  switch (k & 3) {
    case 0: break;
    case 1: du = v, dv = -u; break;
    case 2: du = -u, dv = -v; break;
    default: du = -v, dv = u; break;
  }
}

std::string at(const std::string& what, const char* element, int id) { return what + " at " + element + " " + std::to_string(id); }

std::vector<std::string> violations_of_frames(const FrameField& field, const TriangleMesh& mesh) {
  std::vector<std::string> found;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const Vector3 &du = field.du[f], &dv = field.dv[f];
    if (!du.allFinite() || !dv.allFinite()) {
      found.push_back(at("frame is not finite", "face", f));
      continue;
    }
    const Vector3 normal = mesh.normal(f);
    const double scale = du.norm() + dv.norm();
    if (!(du.cross(dv).dot(normal) > 0)) found.push_back(at("frame has no positive determinant", "face", f));
    if (std::abs(du.dot(normal)) + std::abs(dv.dot(normal)) > 1e-6 * scale)
      found.push_back(at("frame leaves the plane", "face", f));
  }
  return found;
}

/// \return true if the half-edges with matching 0 connect every component's faces
bool is_combed(const FrameField& field, const TriangleMesh& mesh) {
  std::vector<char> by_any(mesh.face_count(), 0), by_zero(mesh.face_count(), 0);
  const auto flood = [&](int seed, std::vector<char>& seen, bool only_zero) {
    std::vector<int> stack{seed};
    seen[seed] = 1;
    int count = 0;
    while (!stack.empty()) {
      const int f = stack.back();
      stack.pop_back();
      ++count;
      for (int h = 3 * f; h < 3 * f + 3; ++h) {
        const int o = mesh.opposite(h);
        if (o < 0 || seen[o / 3] || (only_zero && field.matching[h] != 0)) continue;
        seen[o / 3] = 1;
        stack.push_back(o / 3);
      }
    }
    return count;
  };
  for (int f = 0; f < mesh.face_count(); ++f)
    if (!by_any[f] && flood(f, by_any, false) != flood(f, by_zero, true)) return false;
  return true;
}

}  // namespace

FrameField frame_field_from_rows(const WorkingSurface& surface, const FaceAngles& angles, std::vector<Vector3> du,
                                 std::vector<Vector3> dv, const RunContext& context) {
  const TriangleMesh& mesh = surface.mesh;
  const std::vector<double> directions = frame_directions(mesh, du, dv, context);
  FrameField field;
  field.du = std::move(du);
  field.dv = std::move(dv);
  field.matching.assign(mesh.halfedge_count(), 0);
  parallel_chunks(mesh.halfedge_count(), context, [&](int begin, int end) {
    for (int h = begin; h < end; ++h)
      if (!mesh.is_boundary(h)) field.matching[h] = static_cast<std::uint8_t>(turn_across(mesh, angles, directions, h).quarters);
  });
  const std::vector<int> turns = combing_turns(mesh, field.matching);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o >= 0)
      field.matching[h] = static_cast<std::uint8_t>(wrap_turns(turns[o / 3] + field.matching[h] - turns[h / 3] + 4));
  }
  for (int f = 0; f < mesh.face_count(); ++f) turn_rows(field.du[f], field.dv[f], turns[f]);
  const std::vector<int> quarters = vertex_quarters(mesh, angles, directions, nullptr, context);
  field.cone_index.assign(mesh.vertex_count(), 0);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (!surface.features.on_feature[v] && !mesh.is_boundary_vertex(v))
      field.cone_index[v] = static_cast<std::int8_t>(quarters[v]);
  field.feature_cones = count_feature_cones(surface, field.du, field.dv, context);
  return field;
}

int count_feature_cones(const WorkingSurface& surface, const std::vector<Vector3>& du, const std::vector<Vector3>& dv,
                        const RunContext& context) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<char> is_marked(mesh.halfedge_count());
  for (int h = 0; h < mesh.halfedge_count(); ++h) is_marked[h] = surface.features.is_feature(h);
  if (std::find(is_marked.begin(), is_marked.end(), 1) == is_marked.end()) return 0;
  const FaceAngles angles(mesh, context);
  const std::vector<double> directions = frame_directions(mesh, du, dv, context);
  std::vector<int> quads(mesh.vertex_count(), 0);
  int count = 0;
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (!is_marked[h]) continue;
    const int quarters = sector_quarters(mesh, angles, directions, h, is_marked);
    count += quarters < 1;
    quads[mesh.from(h)] += std::max(1, quarters);
  }
  for (int v = 0; v < mesh.vertex_count(); ++v) count += quads[v] != 0 && quads[v] != 4 && !mesh.is_boundary_vertex(v);
  return count;
}

std::vector<std::string> violations_of(const FrameField& field, const WorkingSurface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  const std::size_t faces = mesh.face_count();
  if (field.du.size() != faces || field.dv.size() != faces || field.matching.size() != 3 * faces ||
      field.cone_index.size() != static_cast<std::size_t>(mesh.vertex_count()))
    return {"array sizes do not fit the mesh"};
  std::vector<std::string> found = violations_of_frames(field, mesh);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o >= 0 && wrap_turns(field.matching[h] + field.matching[o]) != 0)
      found.push_back(at("matchings of the two sides are not inverse", "half-edge", h));
  }
  if (!is_combed(field, mesh)) found.push_back("frames are not combed");

  const std::vector<int> quarters =
      vertex_quarters(mesh, FaceAngles(mesh), frame_directions(mesh, field.du, field.dv), &field.matching);
  int sum = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const bool constrained = surface.features.on_feature[v] || mesh.is_boundary_vertex(v);
    sum += constrained ? quarters[v] : field.cone_index[v];
    if (constrained && field.cone_index[v] != 0) found.push_back(at("cone on a feature", "vertex", v));
    if (!constrained && field.cone_index[v] != quarters[v])
      found.push_back(at("cone index disagrees with matchings", "vertex", v));
  }
  if (sum != 4 * mesh.euler_characteristic())
    found.push_back("indices sum to " + std::to_string(sum) + ", not to 4 times the Euler characteristic");
  return found;
}

}  // namespace hybrid_quad
