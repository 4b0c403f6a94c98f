#pragma once

#include <optional>
#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/features/features.h"
#include "hybrid_quad/frame_field/guide_map.h"
#include "hybrid_quad/improve/futile_mending.h"
#include "hybrid_quad/improve/ring_pulls.h"
#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/mesh/segment_index.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

struct ImproveOptions {
  bool edit_connectivity = true;   ///< valence moves, chain repair, wedge templates
  int smoothing_sweeps = 20;
  double chord_spring = 5.0;       ///< pulls curve vertices to equal chord error, more where curves bend
  bool fit = true;                 ///< one offset pass that halves the distance; vertices then straddle the surface
  double aspect_power = 0.7;       ///< 0: quads become squares; 1: they keep whatever aspect they have
  double area_weight = 0.05;       ///< of areas near those asked for, or else near those around
  const std::vector<double>* asked_lengths = nullptr;  ///< #V of the input: edge lengths that quads are to keep to
  const GuideMap* guides = nullptr;  ///< on the input: directions that edges keep to
  const RingPulls* rings = nullptr;  ///< edges that lines are to cross in the middle; only where connectivity stays
  double target_length = 0;        ///< mean quad edge, 0 = measured
  Agreement agreement;  ///< what of the surface has to agree with a quad (flawed_quads), so that there is no doubt
  Agreement least_agreement;  ///< what has to, or the quad is flawed beyond doubt: no shape is worth that
  /// Of the surface's tree, by a search for better shapes, before it ends: where parts are crumpled and nearly flat a look opens hundreds
  /// instead of ten or twenty, which would take minutes.
  long long most_boxes_opened = 40'000'000;
};

struct ImproveReport {
  int connectivity_moves = 0;
  int inverted_after = 0;
  int flawed_after = 0;  ///< flawed_quads
  int mended = 0;                  ///< changes that only flawed quads called for
  int placed = 0;  ///< places around quads of poor shape that were searched anew with success
  int released_tips = 0;  ///< 1 where tips hold nothing, as quads they held came out flawed
  int restored_quads = 0;  ///< quads left as they were extracted, where improving them brought flaws or took them off the surface
};

/// Quads that one round has improved.
struct Improved {
  QuadMesh quads;
  ImproveReport report;
  std::vector<Vector3> tips;  ///< that held some of them
  std::vector<int> flawed;
};

/// The first of the rounds of improve_quads: what comes out, but for places that are given up on and parts that are left.
/// \param whole  as for improve_quads
Improved improve_once(const QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                      const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole = nullptr);

/// Makes the quads good without leaving the surface: connectivity moves that lower the valence cost, then smoothing and
/// untangling (regularised corner energy) with vertices on the input surface, curve vertices on their curves and corners
/// fixed. Never makes a valid mesh invalid (checked move by move), and gives up on places that come out flawed but were not
/// before: these stay as they are.
/// \param whole  the surface that `input` is part of, which flaws are judged by; null: `input` is all of it
/// \param first  what improve_once made of the same quads, if it did
ImproveReport improve_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features,
                            const SurfaceIndex& index, const ImproveOptions& options, const RunContext& context,
                            const SurfaceIndex* whole = nullptr,
                            std::optional<Improved> first = std::nullopt);

/// The Catmull-Clark limit surface of the quads against the surface, in scene units; `mean` is by area.
struct LimitFitReport {
  DirectedDistance before, after;  ///< from the limit surface to the surface
  int held_back = 0;               ///< vertices that move less than they should, or not at all
};

/// Moves vertices so that the Catmull-Clark limit surface of the quads lies on the surface, and the limit curves of feature
/// edges, which are infinitely sharp creases, on the feature curves. Corners stay, as infinitely sharp vertices. By linear
/// least squares between projections (Hoppe et al., *Piecewise smooth surface reconstruction*, 1994; limit points
/// by OpenSubdiv), with springs against the change. No quad becomes inverted, or bad (scaled Jacobian below 0.3) and worse
/// than it was; where the mean distance would not fall nothing moves. The vertices then lie off the surface, on the outside of
/// where it bends.
/// \param curves  for each curve of the quads' feature edges its segments
/// \pre `quads` is valid (violations_of)
LimitFitReport fit_limit_surface(QuadMesh& quads, const SurfaceIndex& surface, const std::vector<SegmentIndex>& curves,
                                 const RunContext& context);

/// Which number of quads to bring a mesh to, one quad at a time.
struct QuadNumber {
  int wanted = 0;
  /// #V of the input: edge lengths asked for. Quads that are small against them are taken out, those that are large are split.
  const std::vector<double>& lengths;
  bool is_on_the_way = false;  ///< far from the wanted one still, when this is met: shapes are made anew afterwards, and what keeps them takes most tries
};

/// Takes single quads out, or puts some in, until there are as many as wanted or no more can be without new flaws. Features, the
/// boundary and the topology stay. Improving afterwards is left to the caller.
/// \pre the quads are improved  \param whole  as for improve_quads
/// \returns quads put in, less those taken out
int change_quad_number(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                       const ImproveOptions& options, const QuadNumber& number, const RunContext& context,
                       const SurfaceIndex* whole = nullptr);

/// Against quads that are flawed when all else is done: a side of one is split in three, with both quads at it, where that leaves
/// fewer. Mostly sides that cut a feature curve's bend off. Each split adds two to six quads; all other vertices stay, unless it
/// takes mending.
/// \param agreement  of flawed_quads  \param whole  as for improve_quads
/// \param trials  of splits that may be made, in this call and those that are to share them; fewer afterwards
/// \returns sides split
int split_flawed_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                       const ImproveOptions& options, const Agreement& agreement, const RunContext& context,
                       const SurfaceIndex* whole = nullptr, int* trials = nullptr);

/// Against quads with a scaled Jacobian of zero or less (or hardly more), flawed or not: mostly quads between corners and curves, whose
/// places are given. A side is split in three, or two sides one after the other, and the vertices of the quad, of those around it and
/// within these find new places as in raise_shapes, where that leaves fewer such quads or a much better worst one. The rest of the mesh
/// stays. No more are flawed or in doubt afterwards, and there are hardly more quads: a fiftieth, or eight.
/// \param whole  as for improve_quads  \param ended_searches  null, or one more where options.most_boxes_opened has ended it with quads left
/// \returns sides split
int split_folded_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                       const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole = nullptr,
                       int* ended_searches = nullptr);

/// Against quads that are still flawed: these and some rings around are refined, three by three, and relaxed, where that leaves
/// fewer. Where sides cut through what they should go around, all of them get bends at once. Much more is changed than by
/// splitting sides, and eight quads are added for every one refined.
/// \param agreement  of flawed_quads  \param whole  as for improve_quads
/// \returns places refined
int refine_flawed_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                        const ImproveOptions& options, const Agreement& agreement, const RunContext& context,
                        const SurfaceIndex* whole = nullptr);

/// Around quads of poor shape (scaled Jacobian below 0.2), the worst first, moves vertices over the surface and along their curves
/// so that the worst corners there get better: Gauss-Seidel descent on a soft maximum of the corners' faults, as energies that
/// spread over all quads (improve_quads) leave a few bad ones for the sake of many good ones. Connectivity stays; a place is kept
/// only if no more quads are flawed (by the agreement that improving asks for) or folded there, the worst is no worse, and all
/// together are better.
/// \param whole  as for improve_quads  \param ended_searches  as for split_folded_quads
/// \param futile  null, or where it has failed in meshes like this one, elsewhere perhaps different: not tried again there
/// \returns places where shapes are better now; 0: nothing has moved
int raise_shapes(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                 const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole = nullptr,
                 int* ended_searches = nullptr, FutileMending* futile = nullptr);

/// Where the quads end short of the surface, as at the tips of fingers, horns and fins, which lie inside a quad once it is extracted or off
/// which quads slip while they get better shapes: moves vertices there over the surface so that the quads come nearer to the points
/// farthest from them. Connectivity stays; a place is kept only if a fifth of what is more than near is gone there (squares of distances, summed), its
/// largest distance is no larger, no more quads are flawed or folded, and none has a scaled Jacobian below 0.4 and the worst before
/// (docs/decisions/0044).
/// \param whole  as for improve_quads
/// \returns places where the quads reach farther now; 0: nothing has moved
int reach_cut_parts(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                    const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole = nullptr);

/// Where the input bends by more than the sharp angle along edges that are no features (single ones, those on rough surfaces, those that gave
/// way): moves free vertices over the surface so that sides of quads come to lie along them, as far as the quads bear it. Where no side is
/// within .15 edge lengths the vertices of four rings relax with pulls of the nearest sides to the edges, stronger and stronger. A place is
/// kept only if no edge is farther there than the farthest was, a twentieth of what is more than near is gone (squares of distances, summed), no quad
/// has lost more than .08 of its scaled Jacobian below .8, all together little, and no more are flawed or folded (docs/decisions/0048).
/// \param sharp_angle  degrees  \param whole  as for improve_quads
/// \returns places where sides are nearer now; 0: nothing has moved
int follow_creases(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                   double sharp_angle, const ImproveOptions& options, const RunContext& context,
                   const SurfaceIndex* whole = nullptr);

/// The last resort against quads without area (below 1e-10 of the squared edge length): a vertex or two of each move by at most
/// a ten thousandth of the edge length so that it has one, on the side to which the quads around it point. Free vertices go first,
/// then those on curves; a corner that has to move is no input vertex any more (anchor -1).
/// \param edge  mean edge length of all that the quads are part of
/// \param surface  null, or the quads around one that is opened are not to be flawed beside it (`is_flawed`): where they are, other
///     vertices and steps up to 25 times as long are tried
/// \returns number of quads opened
int open_flat_quads(QuadMesh& mesh, double edge, const SurfaceIndex* surface = nullptr, const Agreement& agreement = {});

}  // namespace hybrid_quad
