#pragma once

#include <array>
#include <string>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Raw polygons as they come from a file or a Blender mesh.
struct PolygonSoup {
  std::vector<Vector3> positions;
  std::vector<int> face_sizes;     ///< corners of each polygon
  std::vector<int> face_vertices;  ///< the polygons' vertices, one polygon after the other
};

/// One kind of defect, with the input elements that show it.
struct Defect {
  std::string code;          ///< e.g. "non_manifold_edge", "flipped_face", "duplicate_face", "zero_area_face", "isolated_vertex", "non_finite_vertex"
  std::string element_kind;  ///< "vertex", "edge" (elements are then vertex pairs, flattened) or "face"
  std::vector<int> elements;
  bool repairable = false;   ///< remesh goes on
  bool kept = false;         ///< and leaves it as it is; false: repairs it
  std::string remedy;        ///< what remesh does about it, or what the user can do
};

/// The clean mesh and how it relates to the input.
struct BuiltMesh {
  TriangleMesh mesh;
  std::vector<int> input_vertex;  ///< #V: polygon-soup vertex it came from
  std::vector<int> input_face;    ///< #F: polygon it is part of
  std::vector<int> welded_into;   ///< one for each vertex of the polygon soup: the one that it was merged into, or itself
  std::vector<Defect> defects;    ///< what was found, and repaired, on the way
};

/// Finds defects without changing anything, and oddities_of() what can be remeshed. Where faces or their vertices are a reason to refuse the
/// mesh, what is wrong with the others is found too; what a run is refused for comes last.
std::vector<Defect> check_mesh(const PolygonSoup& soup);

/// Triangulates polygons (ear clipping in their best plane), drops what has no area, welds exact coincidences where that closes cracks,
/// orients faces consistently, splits non-manifold edges and vertices into manifold sheets.
/// \throws InputError empty_mesh, index_out_of_range, non_finite_vertex, non_orientable, no_area, coordinate_outlier ...; Cancelled
BuiltMesh build_mesh(const PolygonSoup& soup, const RunContext& context = {});

/// The same. \param defects  gets what was found, also where that is a reason to refuse the mesh, which then comes last
BuiltMesh build_mesh(const PolygonSoup& soup, std::vector<Defect>& defects);

}  // namespace hybrid_quad
