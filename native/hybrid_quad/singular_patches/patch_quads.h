#pragma once

#include <string>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// A connected piece of the singular region, cut out along grid edges and features and refined (paper 4.4).
/// Its boundary loops are chains of arcs; an arc becomes one quad edge and runs between two nodes, one a
/// minimum, one a maximum.
struct PatchSurface {
  TriangleMesh mesh;
  std::vector<double> morse;  ///< #V: Psi^0; strictly monotone along every arc, -1.01 / +1.01 at nodes
  std::vector<int> node;      ///< #V: id of the quad vertex a border extremum is, or -1
  std::vector<int>
      boundary_arc;          ///< 3 #F: id of the arc a boundary half-edge is part of, -1 for inner half-edges
  double target_length = 0;  ///< quad edge length here (scene units)
};

/// Quads of a patch with their gluing. Vertices are local; `node` ties the border ones to the rest of the
/// mesh.
struct PatchQuads {
  std::vector<Vector3> positions;         ///< #V
  std::vector<int> node;                  ///< #V: node id, or -1 for a vertex inside the patch
  std::vector<std::array<int, 4>> quads;  ///< counterclockwise
  std::vector<int> opposite;  ///< 4 #Q, dart 4 q + i as in QuadComplex: the glued dart, or -1 on the border
  std::vector<int> arc;       ///< 4 #Q: the arc a border dart lies on, -1 inside
};

/// The quasi-dual Morse-Smale complex of `morse`: one quad per saddle, its corners the two minima and two
/// maxima that the saddle's paths reach (paper 4.4, App. A; Edelsbrunner et al. 2003; Robins et al. 2011 for
/// the discrete gradient; ties broken by vertex id, simulation of simplicity). Pairs of persistence below
/// `persistence` are cancelled. The border comes out right whatever the values inside. The shapes may break
/// violations_of: repair_complex mends that later, or the caller takes combinatorial_fill. Empty for a sphere
/// with one minimum and one maximum. \throws InternalError if the border is not as promised (border_of)
PatchQuads morse_smale_quads(const PatchSurface& patch, double persistence, const RunContext& context);

/// Quads for any patch whose border loops have an even number (>= 4) of arcs: a triangulation of the patch
/// whose border vertices are every other node, every triangle split into three quads at its centroid and edge
/// midpoints (the other nodes are the midpoints of border edges). A small disk is filled with as few quads as
/// its angles and size ask for instead. Always valid, seldom pretty: the last resort. \throws InternalError
/// if the border is not as promised (border_of)
PatchQuads combinatorial_fill(const PatchSurface& patch, const RunContext& context);

/// Gluing is an involution; every arc is covered by exactly one border dart whose ends are the arc's nodes;
/// Euler characteristic and border loops are the patch's; no interior vertex of valence < 3, no quad with a
/// repeated vertex, no two quads with two common edges.
std::vector<std::string> violations_of(const PatchQuads& quads, const PatchSurface& patch);

/// The part of violations_of that repair_complex does not mend once the patch is in its place: gluing,
/// border, topology. What it leaves out are shapes: inner valences below 3, quads that repeat a vertex or
/// share two edges.
std::vector<std::string> structural_violations_of(const PatchQuads& quads, const PatchSurface& patch);

}  // namespace hybrid_quad
