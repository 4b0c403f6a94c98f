#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/features/features.h"
#include "hybrid_quad/improve/curve_geometry.h"
#include "hybrid_quad/improve/edit_mesh.h"
#include "hybrid_quad/mesh/surface_walk.h"
#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// Where a vertex is: in space, over the input, along its curve.
struct VertexPlace {
  Vector3 position;
  int face;
  double arc;
};

/// The mesh under improvement and where its vertices sit on the input: a face under a free vertex, an arc length for a
/// vertex on a curve, an input vertex for a corner.
struct Workpiece {
  Workpiece(const QuadMesh& quads, const TriangleMesh& input_mesh, const FeatureGraph& feature_graph,
            const SurfaceIndex& surface_index);

  const TriangleMesh& input;
  const FeatureGraph& features;
  const SurfaceIndex& index;
  EditMesh mesh;
  double h = 0;                       ///< typical edge length; 0: nothing to improve
  std::vector<CurveGeometry> curves;  ///< by curve id
  std::vector<int> face;              ///< #V: input face under a free vertex, -1 where there is none
  std::vector<double> arc;            ///< #V: position of a curve vertex
  std::vector<int> previous, next;    ///< #V: a curve vertex's neighbours along its curve, -1 where the chain ends
  std::vector<int> region;            ///< #Q: region of the input the quad covers, -1 if unknown

  /// Puts all vertices where their kind allows: corners and curve vertices exactly, free ones at the nearest point.
  void bind_all(const RunContext& context = {});
  /// Finds these places, and leaves the vertices where they are: a fitted mesh is not on the surface.
  void locate_all(const RunContext& context = {});
  /// Puts free vertex v at the point of its region nearest to where it is, on a face that looks along `normal`
  /// (zero: any).
  void bind_free(int v, const Vector3& normal);
  /// The nearest point that can be reached from an input face without leaving its region.
  SurfacePoint walk(const Vector3& p, int start) const { return walk_to_nearest(input, features.face_region, p, start); }
  /// \param near  an input face that may be near, -1: none known
  int add_vertex(const Vector3& position, int region_id, const Vector3& normal, int near = -1);
  int add_quad(const EditMesh::Quad& corners, int region_id);

  int region_filter(int id) const { return id >= 0 && id < region_count ? id : -1; }
  /// Arc length from a curve vertex to its neighbour along the curve (+1) or against it (-1), weighted by curvature.
  double weighted_gap(int v, int direction) const;
  double gap(int v, int direction) const;
  /// How far v may slide along its curve: not to its neighbour, nor nearer to it than a tenth of an edge. With less between two
  /// vertices nothing would part them again.
  /// \param edge  typical length around v
  double room(int v, int direction, double edge) const;
  /// Mean length of the edges at v.
  double edge_at(int v) const;
  /// Whether v is on a curve that has a length.
  bool may_slide(int v) const;
  /// Whether v has another place to go to, over the input or along its curve.
  bool may_move(int v) const;
  VertexPlace place_of(int v) const { return {mesh.positions[v], face[v], arc[v]}; }
  void put(int v, const VertexPlace& place);

  int region_count = 0;

 private:
  void place_on_curves();
  void find_quad_regions();
};

/// Arc lengths of the vertices of a chain along its curve: nearest points where those are in order, evenly between
/// neighbours elsewhere; strictly increasing (cyclically on a closed curve).
/// \param at_ends  the first and the last vertex are the curve's ends
std::vector<double> chain_arc_lengths(const CurveGeometry& curve, const std::vector<Vector3>& points, bool at_ends);

}  // namespace hybrid_quad
