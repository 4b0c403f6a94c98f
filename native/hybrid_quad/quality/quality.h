#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/features/features.h"
#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// Scaled Jacobian of a quad: the smallest over its corners of the sine of the corner's angle, signed by the quad's own
/// normal (Knupp 2000). In [-1, 1]; -1 for a quad without area.
double scaled_jacobian(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

struct ShapeQuality {
  double scaled_jacobian_mean = 0;
  double scaled_jacobian_p1 = 0;  ///< first percentile (linear interpolation)
  double scaled_jacobian_min = 0;
  int below_zero = 0;             ///< quads with scaled Jacobian <= 0
  int poor = 0;                   ///< quads with scaled Jacobian < 0.2: so narrow, skew or folded that it shows
  int irregular_vertices = 0;     ///< interior vertices of valence != 4
};

ShapeQuality shape_quality(const QuadMesh& mesh);

/// The edges as chains that go straight on at every vertex of four quads (of two along the boundary), to an irregular vertex, a
/// corner or the boundary, or around to where they began.
struct EdgeLoopSummary {
  int closed = 0, open = 0;
  int longest = 0;           ///< edges
  double median_length = 0;  ///< edges
  int self_crossing = 0;     ///< that pass a vertex twice
  int spirals = 0;           ///< that pass beside themselves in the same direction, at most three quads across
  int longest_spiral = 0;    ///< edges
};

/// \pre `mesh` is valid (violations_of)
EdgeLoopSummary edge_loops_of(const QuadMesh& mesh);

/// What must agree with a quad near it, so that it does not point against the surface: so much area (scene units squared) or
/// the middle of a face.
struct Agreement {
  double area = 0;            ///< 0: whatever there is
  bool or_coincides = false;  ///< or the inside of a face that is as near as the nearest one, however small the quad
};

/// What looking a quad up on the surface left behind.
struct Lookup {
  int face = -1;               ///< in: one that may be near, -1: none known; out: the nearest one
  long long boxes_opened = 0;  ///< of the surface's tree; added to: how much work it is, the same on every machine
};

/// Whether a quad points against the surface: against a face at its nearest point and against nearly all of it within a
/// quarter of the quad's mean edge length beyond that, so that the far side of a thin sheet does not count. Of what is as near
/// as the nearest point, at an edge or where sheets coincide, any face counts.
/// \param lookup  null, or of the quad's last places: the answer is the same, and is found sooner
bool is_inverted(const std::array<Vector3, 4>& corners, const SurfaceIndex& surface, const Agreement& agreement = {},
                 Lookup* lookup = nullptr);

/// All quads that are. Ascending.
std::vector<int> inverted_quads(const QuadMesh& mesh, const SurfaceIndex& surface, const Agreement& agreement = {}, int threads = 1);

/// Whether a quad is inverted or has no more than so much area (scene units squared).
/// \param lookup  as for is_inverted
bool is_flawed(const std::array<Vector3, 4>& corners, double least_area, const SurfaceIndex& surface,
               const Agreement& agreement = {}, Lookup* lookup = nullptr);

/// Quads that are, where the least area is 1e-10 of the squared mean edge length. Ascending.
std::vector<int> flawed_quads(const QuadMesh& mesh, const SurfaceIndex& surface, const Agreement& agreement = {}, int threads = 1);

/// Those of `candidates` (ascending) that are. Ascending.
std::vector<int> flawed_among(const std::vector<int>& candidates, const QuadMesh& mesh, const SurfaceIndex& surface,
                              const Agreement& agreement);

/// Distances in percent of the diagonal of the input's bounding box.
struct SurfaceDistance {
  double quads_to_input_max = 0;
  double input_to_quads_max = 0;
  double mean = 0;  ///< mean of the two directions' means
  double hausdorff() const { return quads_to_input_max > input_to_quads_max ? quads_to_input_max : input_to_quads_max; }
};

/// For each point (scene units) the nearest place on the quads, each split along its first diagonal; `face` is a quad. #points, in
/// their order, the same for any number of threads.
/// \pre `quads` is valid (violations_of)
std::vector<SurfacePoint> nearest_on_quads(const std::vector<Vector3>& points, const QuadMesh& quads, const RunContext& context);

/// Where a surface is farthest from its quads.
struct FarthestPlace {
  Vector3 place;  ///< on the surface, scene units
  double edges = 0;  ///< how far the quads are from it, in mean lengths of their edges
};

/// Looked for among the surface's vertices, several for a quad, evenly strided. The same for any number of threads.
/// \pre `quads` is valid (violations_of)
FarthestPlace farthest_from_quads(const TriangleMesh& surface, const QuadMesh& quads, const RunContext& context);

/// Symmetric distance between the quads (each split along its first diagonal) and the input, from evenly spread samples
/// and the vertices of both. The same for any number of threads.
/// \pre `quads` is valid (violations_of)
SurfaceDistance surface_distance(const QuadMesh& quads, const SurfaceIndex& input, const RunContext& context,
                                 int samples = 40000);

/// Mean of surface_distance() by few samples, in usual edge lengths of the quads.
double mean_distance_in_edges(const QuadMesh& quads, const SurfaceIndex& input, const RunContext& context);

/// How far one surface is from another, in scene units: from evenly spread samples and the vertices. The same for any
/// number of threads.
struct DirectedDistance {
  double largest = 0, mean = 0;
};
DirectedDistance directed_distance(const TriangleMesh& from, const SurfaceIndex& to, const RunContext& context,
                                   int samples = 20000);

/// #points: how far each is from a surface. The same for any number of threads.
std::vector<double> point_distances(const std::vector<Vector3>& points, const SurfaceIndex& to, const RunContext& context);

/// Largest distance from the input's feature curves to the quads' feature edges, in percent of the diagonal; 0 without
/// feature curves, 100 where there are curves but no feature edges.
double feature_distance(const QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features,
                        const RunContext& context);

}  // namespace hybrid_quad
