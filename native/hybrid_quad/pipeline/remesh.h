#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/periodic_field/periodic_field.h"
#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

/// Which mirror planes through the origin the result is to be symmetric about.
struct SymmetryOptions {
  PlaneSet planes = 0;      ///< used however symmetric the surface is; the positive side is kept
  bool detect = false;      ///< use also those about which the surface is symmetric
  double tolerance = 0.25;  ///< largest deviation that counts as symmetric, in percent of the diagonal
};

/// A path of input vertices, each joined to the next by an edge of a polygon, along which the result is to have exactly
/// `count` quad edges. A loop repeats its first vertex at the end.
struct CurveCount {
  std::vector<int> vertices;
  int count = 0;
};

struct RemeshOptions {
  /// Whether the number of quads counts, not their lengths.
  bool is_by_count() const { return !(edge_length > 0 || chord_error > 0); }

  int quads = 5000;                ///< asked number of quads (ignored where edge_length > 0)
  double edge_length = 0;          ///< asked quad edge length (scene units)
  bool use_sharp_angle = true;
  double sharp_angle = 40;         ///< degrees between face normals that make a feature edge
  std::vector<std::array<int, 2>> marked_edges;  ///< pairs of input vertices that are features whatever their angle
  /// Directions that edges should take: vectors in the coordinates of the input, one for each vertex (or polygon, or both,
  /// where a polygon's own goes first), or none. Zero: free; the length is the strength, 0..1.
  std::vector<Vector3> vertex_guides, face_guides;
  std::vector<GuideStroke> strokes;  ///< hard guides: lines that are to be chains of edges, or to cross edges in their middles
  /// One for each vertex, or none: 2 asks for edges half as long. 0.1..10, relative unless edge_length > 0.
  std::vector<double> density;
  /// Frames: the two edge vectors of a quad, in usual edge lengths; neither equal nor orthogonal they need to be. Two zero
  /// vectors: free. By vertex or polygon, as guides.
  std::vector<std::array<Vector3, 2>> vertex_frames, face_frames;
  /// Their edges are features whatever their angle, and the ends of open ones corners. No edge in two of them.
  std::vector<CurveCount> curve_counts;
  double field_smoothness = 0.5;   ///< 0: edges follow the surface's bends, 1: as few singularities as can be
  double adaptivity = 0;           ///< 0: even, 1: edges as short as the surface's curvature asks for
  /// Largest distance that quads may have from the surface (scene units); 0: none. Sets the lengths by the curvature, in
  /// place of `quads` and `adaptivity`; edge_length is then the longest edge, an eighth of the extent (TriangleMesh::extent) where not given.
  double chord_error = 0;
  double anisotropy = 1;           ///< most by which quads are stretched along the direction that bends less
  int narrow_quads = 2;            ///< rows of quads, 1 or 2, that a strip between two features gets, however narrow
  double size_fidelity = 0.5;      ///< 0: as few irregular vertices as can be, 1: the asked lengths, whatever that takes
  PeriodicSolver solver = PeriodicSolver::kMultilevel;
  bool improve = true;
  bool fit = true;                 ///< let free vertices leave the surface a little so that the quads' faces lie nearer to it
  bool fit_limit_surface = false;  ///< move vertices off the surface so that their Catmull-Clark limit surface lies on it
  SymmetryOptions symmetry;
  bool measure_distances = true;   ///< hold the result against the surface once more for the report, a tenth of a run
};

struct StageRecord {
  std::string name;
  double seconds = 0;
  double peak_mb = 0;  ///< peak resident memory of the process at the end of the stage
};

/// How the singular patches were filled.
struct PatchRecord {
  int count = 0;
  int morse_smale = 0;
  int combinatorial = 0;
  double combinatorial_area_fraction = 0;
};

/// Whatever had to be put right on the way: nothing of it makes the result invalid, but a stage before could be better
/// where much of it happens.
struct RepairRecord {
  int broken_promises = 0;       ///< stages that gave up; the extraction then went on with less of them
  int released_quads = 0;        ///< regular quads given to a patch next to them that could not be filled
  int removed_quads = 0;         ///< at inner vertices of valence 1 and 2
  int added_rings = 0;           ///< rings of quads and stars that undo double edges where nothing can be removed
  int split_polychords = 0;      ///< strips doubled to make room
  int fitted_rows = 0;           ///< strips doubled or taken out for the number of quads
  int fitted_quads = 0;          ///< quads put in or taken out one by one for the number
  int opened_straight_quads = 0; ///< quads with three sides on one feature
  int mended_places = 0;         ///< changes that only flawed quads called for
  int poor_places = 0;  ///< around quads of poor shape, whose vertices were placed anew
  int split_sides = 0;           ///< sides of flawed or folded quads split in three, when all else was done
  int refined_places = 0;        ///< around flawed quads that were refined, where that was not enough
  int reached_places = 0;        ///< tips that quads had ended short of
  int followed_creases = 0;  ///< places where edges of quads were brought to creases that are no features
  int raised_places = 0;         ///< around quads of poor shape that got a better one in the end
  int ended_searches = 0;  ///< for better shapes, with quads left, as each look at the surface takes long
  int opened_flat_quads = 0;     ///< quads without area to which a vertex moved by a hair gave one
  int split_triangles = 0;  ///< of components that are made of their own triangles, as all else left flawed quads
  int released_tips = 0;  ///< times that tips held nothing, as quads they held came out flawed
  int restored_quads = 0;  ///< quads left as they were extracted, where improving them brought flaws or took them off the surface

  RepairRecord& operator+=(const RepairRecord& other);
};

/// The mirror planes that were used; the deviation of all three where any were asked for.
struct SymmetryRecord {
  PlaneSet planes = 0;
  bool is_measured = false;
  std::array<PlaneDeviation, 3> deviation;
};

/// What became of one of options.curve_counts.
struct CurveCountRecord {
  int asked = 0;
  int got = 0;         ///< 0: nothing of it is on the remeshed part of the surface
  std::string reason;  ///< why it is another number; empty where it is not
};

/// The two solutions of the field, summed over components: sum of |index|, and in how many components it was kept.
struct FieldRecord {
  int relaxed_quarters = 0, smoothest_quarters = 0;
  int relaxed_kept = 0, smoothest_kept = 0;
};

/// How far the Catmull-Clark limit surface is from the input, where options.fit_limit_surface asks for it: in percent of the
/// diagonal, before and after vertices moved.
struct LimitFitRecord {
  bool is_fitted = false;
  DirectedDistance before, after;
  int held_back = 0;  ///< vertices that moved less than they should, for quads around them would get bad
};

/// What became of a hard guide.
struct GuideRecord {
  GuideKind kind = GuideKind::kLoop;
  bool is_met = false;
  GuideFit fit;
};

struct RemeshReport {
  int input_vertices = 0, input_faces = 0, working_faces = 0, components = 0;
  int quads = 0, vertices = 0;
  int fewest_quads = 0;                  ///< no mesh of quads with these parts, handles and holes has fewer
  int irregular_vertices = 0;            ///< interior vertices of valence != 4
  int field_singularities = 0;           ///< inside the surface, on features too
  int feature_singularities = 0;         ///< those of them that features force: corners, mostly
  FieldRecord field;
  int dislocations = 0;                  ///< left after cancellation
  int dislocations_found = 0;
  double singular_area_fraction = 0;     ///< part of the surface that Morse patches or fills cover
  PatchRecord patches;
  RepairRecord repairs;
  int features_given_way = 0;            ///< feature curves by angle that gave way to the number of quads or to others
  int marks_given_way = 0;  ///< curves of marked edges and of guides that gave way to valid quads
  double sharp_angle_used = 0;           ///< degrees above which edges by angle were looked at, the most of all components; 0: none were
  int flawed_quads = 0;                  ///< quads that point against the surface or have no area, after all passes
  std::vector<int> flawed_faces;  ///< those of the result that are so beyond doubt; with mirror images none are named
  int extra_passes = 0;                  ///< passes over components beyond the first, to get rid of flawed quads
  EdgeLoopSummary edge_loops;
  double scaled_jacobian_mean = 0, scaled_jacobian_p1 = 0, scaled_jacobian_min = 0;
  bool are_distances_measured = false;
  double hausdorff_percent = 0, mean_distance_percent = 0;
  double feature_hausdorff_percent = 0;  ///< 0 without features
  LimitFitRecord limit_fit;
  SymmetryRecord symmetry;
  std::vector<CurveCountRecord> curve_counts;  ///< as options.curve_counts
  std::vector<GuideRecord> guides;       ///< one for each of options.strokes
  std::vector<StageRecord> stages;       ///< summed over components and passes
  std::vector<std::string> warnings;
  std::vector<Defect> defects;           ///< of the input, repaired on the way
};

struct RemeshResult {
  QuadMesh mesh;
  RemeshReport report;
};

/// The whole method: any polygon soup that is a surface in, a valid pure-quad mesh of the same topology out.
/// \throws InputError if the input is no surface (names the elements); Cancelled; InternalError (a bug)
RemeshResult remesh(const PolygonSoup& soup, const RemeshOptions& options, const RunContext& context);

}  // namespace hybrid_quad
