#pragma once

#include <array>
#include <string>
#include <vector>

#include "hybrid_quad/mesh/quad_mesh.h"

namespace hybrid_quad {

/// A 2-manifold complex of quadrilaterals whose edges are darts, never vertex pairs: dart d = 4 q + i runs
/// along side i of quad q from corner i to corner i + 1. Always manifold by construction (docs/guarantee.md, step 8),
/// whatever an indexed mesh could hold: faces may meet themselves, share two edges, and vertices may have any
/// valence.
struct QuadComplex {
  std::vector<int> opposite;       ///< 4 #Q: the dart on the other side, -1 on the boundary
  std::vector<int> vertex;         ///< 4 #Q: origin of the dart
  std::vector<int> curve;          ///< 4 #Q: feature curve the side lies on, or -1 (same on both sides)
  std::vector<Vector3> positions;  ///< #V
  std::vector<VertexKind> kind;    ///< #V
  std::vector<int> anchor;         ///< #V, as in QuadMesh
  std::vector<int> near_face;      ///< #V, as in QuadMesh

  int quad_count() const { return static_cast<int>(opposite.size()) / 4; }
  static int next(int d) { return (d & ~3) | ((d + 1) & 3); }
  static int previous(int d) { return (d & ~3) | ((d + 3) & 3); }
  int from(int d) const { return vertex[d]; }
  int to(int d) const { return vertex[next(d)]; }
};

/// The complex of an indexed quad list: sides with the same two vertices are glued, all vertices free (anchor
/// 0), no curves. \throws InternalError if a side is used twice in the same direction, or by more than two
/// quads
QuadComplex complex_of_quads(std::vector<Vector3> positions, const std::vector<std::array<int, 4>>& quads);

/// The complex of a mesh, with its curves and what vertices are bound to: to_quad_mesh() gives the mesh again.
QuadComplex complex_of(const QuadMesh& mesh);

/// The vertices of a gluing: for each dart the number of its origin, numbered 0.. in the order of their first
/// darts.
std::vector<int> vertex_orbits(const std::vector<int>& opposite);

/// V - E + F, vertices no quad uses not counted.
int euler_characteristic(const QuadComplex& complex);
/// The same of an indexed mesh, which knows sides by their ends alone: there a hole with two sides is none, which
/// violations_of(QuadMesh) cannot see. \pre no violations \throws InternalError as complex_of_quads
int euler_characteristic(const QuadMesh& mesh);

/// Gluing is an involution, sides agree on vertices and curves, every vertex id is one orbit.
std::vector<std::string> violations_of(const QuadComplex& complex);

struct ComplexRepairReport {
  int cancelled_singlets = 0;  ///< quads removed at inner vertices of valence 1
  int merged_doublets = 0;     ///< pairs of quads merged at inner vertices of valence 2
  int inset_quads = 0;      ///< quads with a ring of four put around them where features forbid the two above
  int restarred_edges = 0;  ///< double edges replaced by three quads around a new vertex
  int split_polychords = 0;  ///< dual strips doubled to make room
};

/// Makes the complex one that an indexed polygon mesh can hold (docs/guarantee.md, step 10): removes inner valences 1 and 2,
/// then double edges, edges that are loops and border loops shorter than four, by splitting polychords or,
/// where a strip would be long, by a local change. Topology, feature chains and corners stay. \throws
/// InternalError if a limit of rounds passes
/// \param counted  #curves, or empty: those whose number of edges should stay; strips across them are split last
ComplexRepairReport repair_complex(QuadComplex& complex, const std::vector<char>& counted = {});

/// Vertices and quads keep their numbers. A feature edge is listed once, in the direction of its dart of
/// lower number. \pre no violation an indexed mesh could not hold (repair_complex)
QuadMesh to_quad_mesh(const QuadComplex& complex);

}  // namespace hybrid_quad
