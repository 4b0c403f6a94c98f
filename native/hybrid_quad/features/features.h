#pragma once

#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// A polyline of mesh edges between two nodes of the feature graph, or a closed loop without a node.
struct FeatureCurve {
  std::vector<int> vertices;  ///< in order; a closed curve repeats its first vertex at the end
  bool closed = false;        ///< no node on it (a loop through one node is not `closed`: it starts and ends at that node)
  bool boundary = false;      ///< runs along the surface's boundary
  int asked_count = 0;        ///< quad edges that it is to get, exactly; 0: as many as fit
};

/// Feature and boundary edges of a mesh, as curves between corners (paper 2.5, 3.2).
struct FeatureGraph {
  std::vector<FeatureCurve> curves;
  std::vector<int> halfedge_curve;  ///< 3 #F: the curve a half-edge lies on, or -1; the same on both sides of an edge
  std::vector<char> is_corner;      ///< #V: node of degree != 2 (dangling ends too), or the curve turns by more than 80 degrees
  std::vector<char> on_feature;     ///< #V
  std::vector<int> face_region;     ///< #F: connected region of faces between feature curves
  double sharp_angle = 0;           ///< of detect_features: degrees above which edges by angle were looked at; 0: none were

  /// Of detect_features: rims of holes and pins by angle that are too small for the minimum length, and curves that only facets too narrow for
  /// it showed.
  int left_out = 0;

  bool is_feature(int h) const { return halfedge_curve[h] >= 0; }
};

/// Which vertex between two feature edges is a corner.
struct CornerRule {
  double angle = 100.0;  ///< degrees between the two, below which it may be one
  /// Scene units: and only if the chain turns as sharply seen from so far away. What zigzags between slivers is none (docs/decisions/0055).
  double reach = 0;
};

/// For quads of an edge length.
inline CornerRule corners_for_quads(double length) {
  constexpr double kReach = 0.1;
  return {CornerRule{}.angle, kReach * length};
}

struct FeatureOptions {
  double sharp_angle = 40.0;     ///< degrees between face normals, more where it tells nothing apart (parting_angle.h); > 180 (or use_sharp_angle false) takes none
  bool use_sharp_angle = true;
  double weak_angle = 20.0;      ///< hysteresis: a chain of weaker edges is kept where it joins strong ones
  /// Scene units; about three edges of the quads to come. Connected edges by angle that are shorter than this, counting only
  /// what is clearly a crease seen from a sixth of it away, are taken for noise of a sculpt or scan. Closed curves of eight edges and more
  /// that go around evenly, as the rims of holes, are none: two fifths are enough, and they are seen from half their radius away.
  /// What facets show that are narrow against it counts as noise too (narrow_facets.h). 0: all above the sharp angle are kept.
  double minimum_length = 0.0;
  double corner_angle = CornerRule{}.angle;
  std::vector<std::array<int, 2>> marked_edges;  ///< vertex pairs that are features whatever their angle; never dropped
  std::vector<int> corners;      ///< vertices that are corners in any case, where a feature passes
};

/// Boundary edges, edges by angle and marked edges, traced into curves.
/// \param normals  #F: of the faces, by which creases are told
/// \throws InputError "unknown_edge" if a marked pair is no edge of the mesh
FeatureGraph detect_features(const TriangleMesh& mesh, const std::vector<Vector3>& normals, const FeatureOptions& options,
                             const RunContext& context);
/// By the mesh's own crease_normals.
FeatureGraph detect_features(const TriangleMesh& mesh, const FeatureOptions& options, const RunContext& context);

/// Curves, corners and regions of a given set of feature half-edges. \param is_feature 3 #F, symmetric; boundary is added
/// \param corners  vertices that are corners in any case, where a feature passes
FeatureGraph trace_features(const TriangleMesh& mesh, const std::vector<char>& is_feature, const CornerRule& rule = {},
                            const std::vector<int>& corners = {});

std::vector<std::string> violations_of(const FeatureGraph& features, const TriangleMesh& mesh);

}  // namespace hybrid_quad
