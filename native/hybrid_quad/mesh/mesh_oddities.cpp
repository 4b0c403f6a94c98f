#include "hybrid_quad/mesh/mesh_oddities.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "hybrid_quad/mesh/self_intersection.h"
#include "hybrid_quad/mesh/unit_frame.h"
#include "hybrid_quad/mesh/vertex_spread.h"
#include "hybrid_quad/mesh/vertices_on_faces.h"

namespace hybrid_quad {

namespace {

constexpr const char* kTouching = "stays: sheets that only touch are not joined";
constexpr double kFar = 20;  ///< times farther from the middle than nine tenths of all vertices

void note(std::vector<Defect>& defects, const char* code, const char* kind, std::vector<int> elements, const char* remedy) {
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  if (elements.empty()) return;
  defects.push_back({code, kind, std::move(elements), true, true, remedy});
}

/// The index of the built mesh, moved to where it is of size 1.
SurfaceIndex index_in_unit_frame(const BuiltMesh& built) {
  const UnitFrame frame = unit_frame_of(built.mesh.positions(), false);
  std::vector<Vector3> positions = built.mesh.positions();
  for (Vector3& p : positions) p = frame.inward(p);
  return SurfaceIndex(TriangleMesh(std::move(positions), built.mesh.faces(), built.mesh.opposites()), {});
}

void note_intersections(const BuiltMesh& built, const SurfaceIndex& index, std::vector<Defect>& defects) {
  const SelfIntersections found = self_intersecting_faces(index);
  std::vector<int> polygons;
  for (const int f : found.faces) polygons.push_back(built.input_face[f]);
  note(defects, "self_intersection", "face", std::move(polygons), "stays: the quads intersect there as well");
  if (!found.is_complete)
    defects.push_back({"unknown_intersection", "", {}, true, true, "so many faces lie about one place that not all pairs were looked at"});
}

/// Copies of one input vertex are not meant: where these come from, the mesh was cut and says so.
std::vector<int> touching_vertices(const BuiltMesh& built) {
  const std::vector<Vector3>& positions = built.mesh.positions();
  std::vector<int> order(built.mesh.vertex_count()), touching;
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int v, int w) {
    const Vector3 &p = positions[v], &q = positions[w];
    return std::tie(p.x(), p.y(), p.z(), v) < std::tie(q.x(), q.y(), q.z(), w);
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const int v = built.input_vertex[order[i - 1]], w = built.input_vertex[order[i]];
    if (v == w || positions[order[i - 1]] != positions[order[i]]) continue;
    touching.push_back(v);
    touching.push_back(w);
  }
  return touching;
}

/// The far ones of vertices that faces used, but that are not in the built mesh.
void add_far_of_lost_faces(const BuiltMesh& built, const PolygonSoup& soup, std::vector<int>& far) {
  const VertexSpread spread = spread_of(built.mesh.positions());
  std::vector<char> is_lost(soup.positions.size(), 0);
  for (const int v : soup.face_vertices) is_lost[v] = 1;
  for (const int v : built.input_vertex) is_lost[v] = 0;
  for (std::size_t v = 0; v < is_lost.size(); ++v)
    if (is_lost[v] && spread.ratio(soup.positions[v]) > kFar) far.push_back(static_cast<int>(v));
}

}  // namespace

std::vector<int> far_vertices(const BuiltMesh& built) {
  const VertexSpread spread = spread_of(built.mesh.positions());
  std::vector<int> far;
  for (int v = 0; v < built.mesh.vertex_count(); ++v)
    if (spread.ratio(built.mesh.position(v)) > kFar) far.push_back(built.input_vertex[v]);
  return far;
}

void note_touching_vertices(const BuiltMesh& built, std::vector<Defect>& defects) {
  note(defects, "touching_vertex", "vertex", touching_vertices(built), kTouching);
}

std::vector<Defect> oddities_of(const BuiltMesh& built, const PolygonSoup& soup) {
  std::vector<Defect> defects;
  const SurfaceIndex index = index_in_unit_frame(built);
  note_intersections(built, index, defects);
  std::vector<int> touching = touching_vertices(built);
  for (const int v : vertices_on_faces(index, built.input_vertex)) touching.push_back(built.input_vertex[v]);
  note(defects, "touching_vertex", "vertex", std::move(touching), kTouching);
  std::vector<int> far = far_vertices(built);
  const std::size_t staying = far.size();
  add_far_of_lost_faces(built, soup, far);
  note(defects, "far_vertex", "vertex", far,
       far.size() == staying ? "stays, far from all others" : "far from all others; stays where it has faces with an area");
  return defects;
}

}  // namespace hybrid_quad
