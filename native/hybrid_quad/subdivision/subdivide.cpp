#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/base/interruptible.h"
#include "hybrid_quad/subdivision/catmull_clark_refiner.h"
#include "hybrid_quad/subdivision/subdivision.h"

namespace hybrid_quad {

namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

/// What OpenSubdiv interpolates.
struct Point {
  Vector3 at = Vector3::Zero();
  void Clear(void* = nullptr) { at.setZero(); }
  void AddWithWeight(const Point& other, double weight) { at += weight * other.at; }
};

std::array<int, 2> sorted(const std::array<int, 2>& edge) {
  return {std::min(edge[0], edge[1]), std::max(edge[0], edge[1])};
}

void require_sound(const PolygonSoup& mesh, const SubdivisionOptions& options) {
  const int count = static_cast<int>(mesh.positions.size());
  const auto is_vertex = [count](int v) { return v >= 0 && v < count; };
  std::set<std::array<int, 2>> edges;
  std::size_t begin = 0;
  for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
    const int size = mesh.face_sizes[f], face = static_cast<int>(f);
    if (size < 3 || begin + size > mesh.face_vertices.size())
      throw InputError("malformed_faces", "a face has fewer than three corners", "face", {face});
    for (int k = 0; k < size; ++k) {
      const int a = mesh.face_vertices[begin + k], b = mesh.face_vertices[begin + (k + 1) % size];
      if (!is_vertex(a)) throw InputError("index_out_of_range", "a face has a vertex that is not there", "face", {face});
      edges.insert(sorted({a, b}));
    }
    begin += size;
  }
  for (const std::array<int, 2>& edge : options.crease_edges)
    if (edges.count(sorted(edge)) == 0)
      throw InputError("unknown_edge", "a crease is no edge of a face", "edge", {edge[0], edge[1]});
  for (const int v : options.sharp_vertices)
    if (!is_vertex(v)) throw InputError("index_out_of_range", "a sharp vertex is not there", "vertex", {v});
}

std::vector<float> sharpness_of(const std::vector<double>& values) {
  std::vector<float> out;
  for (const double value : values)
    out.push_back(static_cast<float>(std::min<double>(std::max(value, 0.0), Sdc::Crease::SHARPNESS_INFINITE)));
  return out;
}

ControlMesh control_mesh(const PolygonSoup& mesh, const SubdivisionOptions& options) {
  ControlMesh control;
  control.vertex_count = static_cast<int>(mesh.positions.size());
  control.face_sizes = mesh.face_sizes;
  control.face_vertices = mesh.face_vertices;
  for (const auto& edge : options.crease_edges)
    control.crease_vertices.insert(control.crease_vertices.end(), edge.begin(), edge.end());
  control.crease_sharpness = sharpness_of(options.crease_sharpness);
  control.sharp_vertices = options.sharp_vertices;
  control.vertex_sharpness = sharpness_of(options.vertex_sharpness);
  control.keep_corners = options.keep_corners;
  return control;
}

/// Owns all that OpenSubdiv reads, since its work may outlive a cancelled run.
struct Task {
  PolygonSoup mesh;
  SubdivisionOptions options;
  SubdividedMesh result;
  bool is_refused = false;

  void run() {
    const std::unique_ptr<Far::TopologyRefiner> refiner = catmull_clark_refiner(control_mesh(mesh, options));
    is_refused = !refiner;
    if (is_refused) return;
    Far::TopologyRefiner::UniformOptions uniform(options.levels);
    uniform.fullTopologyInLastLevel = options.limit;
    refiner->RefineUniform(uniform);
    std::vector<Point> points(mesh.positions.size());
    for (std::size_t v = 0; v < points.size(); ++v) points[v].at = mesh.positions[v];
    const Far::PrimvarRefinerReal<double> interpolation(*refiner);
    for (int level = 1; level <= options.levels; ++level) {
      std::vector<Point> finer(refiner->GetLevel(level).GetNumVertices());
      interpolation.Interpolate(level, points, finer);
      points = std::move(finer);
    }
    if (options.limit) {
      std::vector<Point> limit(points.size()), along(points.size()), across(points.size());
      interpolation.Limit(points, limit, along, across);
      for (std::size_t v = 0; v < points.size(); ++v)
        result.normals.push_back(along[v].at.cross(across[v].at).normalized());
      points = std::move(limit);
    }
    for (const Point& point : points) result.positions.push_back(point.at);
    collect_faces(*refiner);
  }

  void collect_faces(const Far::TopologyRefiner& refiner) {
    const Far::TopologyLevel& last = refiner.GetLevel(options.levels);
    for (int f = 0; f < last.GetNumFaces(); ++f) {
      const Far::ConstIndexArray corners = last.GetFaceVertices(f);
      result.quads.push_back({corners[0], corners[1], corners[2], corners[3]});
      int face = f;
      for (int level = options.levels; level > 0; --level) face = refiner.GetLevel(level).GetFaceParentFace(face);
      result.face.push_back(face);
    }
  }
};

}  // namespace

SubdividedMesh subdivide(const PolygonSoup& mesh, const SubdivisionOptions& options, const RunContext& context) {
  require_sound(mesh, options);
  const auto task = std::make_shared<Task>();
  task->mesh = mesh;
  task->options = options;
  run_interruptibly(context, 0, [task] { task->run(); });
  if (task->is_refused) throw InternalError("subdivision", "OpenSubdiv refused the mesh");
  return std::move(task->result);
}

}  // namespace hybrid_quad
