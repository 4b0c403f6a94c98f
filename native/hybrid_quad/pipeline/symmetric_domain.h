#pragma once

#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/pipeline/component.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

/// Which mirror planes a run uses, and how symmetric the surface is about each. Detected ones that leave nothing, as of a flat surface
/// in the plane, or cannot go with those before them, are not used.
SymmetryRecord settle_symmetry(const SymmetryOptions& options, const TriangleMesh& mesh, const RunContext& context);

/// The mesh that is remeshed: the input, or its positive part, and what is asked of it.
struct RemeshDomain {
  TriangleMesh mesh;
  std::vector<int> input_vertex;  ///< #V: polygon-soup vertex, -1 for one that a mirror plane made
  std::vector<char> is_marked;    ///< 3 #F: on an edge marked as a feature
  std::vector<int> counted_curve; ///< 3 #F: on this one of options.curve_counts, or -1
  std::vector<int> guides;        ///< 3 #F: the set of hard guides on the edge, -1: none
  RemeshOptions options;          ///< with the planes that are used
  BuiltMesh values;               ///< no mesh: where in the arrays of `options` the values of a vertex and a face are
  int faces_in_plane = 0;         ///< left out
  std::vector<Defect> defects;    ///< of the positive part: components that are left out of it
};

/// Vertices that a plane made get values between those of their edge's ends; directions, which have no middle, those of the
/// nearer one.
/// Components of the positive part with too little area for quads are left out, as build_mesh() leaves them out of the whole.
/// \param guides  3 #F of built.mesh: as in RemeshDomain
/// \throws InputError as positive_part(), and thin_component or no_area where none has enough
RemeshDomain domain_of(const BuiltMesh& built, const RemeshOptions& options, const std::vector<int>& guides, PlaneSet planes);

/// 3 #F: on a marked edge. A pair of polygon-soup vertices may have become several edges.
std::vector<char> marked_halfedges(const BuiltMesh& built, const std::vector<std::array<int, 2>>& marked);

/// The component's quads with their mirror images; unchanged where no planes are used.
/// \param mesh  of the component  \param marked  pairs of its vertices that are features
QuadMesh whole_of(const ComponentResult& component, const TriangleMesh& mesh,
                  const std::vector<std::array<int, 2>>& marked, const RemeshOptions& options);

/// Number of mirror images that make up the whole.
inline int image_count(PlaneSet planes) {
  return 1 << (has_plane(planes, 0) + has_plane(planes, 1) + has_plane(planes, 2));
}

/// What a user should know about the symmetry that was used: faces left out, another topology.
std::vector<std::string> symmetry_warnings(const RemeshDomain& domain, const TriangleMesh& input, const QuadMesh& result);

}  // namespace hybrid_quad
