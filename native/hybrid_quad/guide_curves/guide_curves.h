#pragma once

#include <array>
#include <string>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/features/features.h"
#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/mesh/segment_index.h"
#include "hybrid_quad/mesh/surface_index.h"

namespace hybrid_quad {

/// What a hard guide asks for.
enum class GuideKind {
  kLoop,  ///< to be a chain of edges
  kRing,  ///< to cross edges at right angles through their middles
};

/// A line on or near the surface.
struct GuideStroke {
  std::vector<Vector3> points;  ///< a closed one repeats the first point, or ends within half an edge length of it
  GuideKind kind = GuideKind::kLoop;
};

/// A stroke on the surface: evenly sampled, in one run or, where parts lie off the surface, in several.
struct StrokeTrace {
  struct Run {
    std::vector<SurfacePoint> samples;  ///< a closed run repeats the first
    bool closed = false;
  };
  std::vector<Run> runs;
  bool is_cut = false;  ///< parts lie off the surface
};

/// A traced stroke to measure against.
class GuideLine {
 public:
  explicit GuideLine(const StrokeTrace& trace);

  struct Place {
    Vector3 position;
    Vector3 along;  ///< unit; over a fifth of an edge either way, so that neither noise nor one side of a kink decides alone
    double distance = 0;
  };
  /// \pre not empty
  Place nearest(const Vector3& p) const;
  bool empty() const { return segments_.empty(); }
  double length() const;

 private:
  std::vector<std::array<Vector3, 2>> segments_;
  std::vector<std::array<Vector3, 2>> along_;  // at the ends of the segments
  SegmentIndex index_;
};

/// The nearest points of a stroke on a surface. Left out is what is farther away than two edge lengths, a twentieth
/// of the surface's diagonal and half the stroke's own segments, and what lies beyond the boundary.
/// \param length  quad edge length
StrokeTrace trace_stroke(const GuideStroke& stroke, const SurfaceIndex& surface, double length);

/// An edge that follows a guide, or that a ring guide crosses.
struct GuideEdge {
  int a, b;   ///< vertices
  int guide;  ///< which stroke
};

/// The same surface with strokes as chains of edges.
struct EmbeddedStrokes {
  TriangleMesh mesh;                           ///< vertices keep their ids, new ones follow
  std::vector<int> face;                       ///< #F: face of the given mesh it lies in
  std::vector<int> vertex_face;                ///< of each new vertex: a face of the given mesh it lies in
  std::vector<GuideEdge> edges;                ///< in no order; an edge comes once for each guide on it
  std::vector<std::array<int, 2>> marked_edges;  ///< the parts of the marked edges
  std::vector<int> source;                     ///< of each part: the marked edge it is of, one of those given
  std::vector<StrokeTrace> traces;             ///< #strokes
  std::vector<std::string> warnings;           ///< each names its stroke
};

/// Traces strokes and inserts them, the later ones into what the earlier ones made of the mesh, so that where two cross
/// there is a vertex. Triangles on the way that are large for a quad are halved first. Strokes pass through vertices that
/// they come very near to. Those that lie off the surface or are shorter than an edge are left out.
/// \param length  quad edge length  \param marked_edges  pairs of neighbouring vertices
EmbeddedStrokes embed_strokes(const TriangleMesh& mesh, const std::vector<std::array<int, 2>>& marked_edges,
                              const std::vector<GuideStroke>& strokes, double length, const RunContext& context);

/// Vertices at which curves bend within less than an edge, around a thin part's rim for example: unless there is a vertex of a
/// quad, the chain cuts the corner.
/// \param chosen  #curves: which ones  \param length  quad edge length
std::vector<int> tight_bends(const TriangleMesh& mesh, const FeatureGraph& features, const std::vector<char>& chosen,
                             double length);

/// Puts a strip of quads in the place of chains of edges, so that what was the chain crosses the strip's inner edges. A
/// chain that ends inside the surface is continued by an edge, and by the shortest way with few turns to its other end or the
/// boundary (the row of quads on one of its sides, or on around the surface), for a strip can't end there.
/// \param chain  edges to be replaced, as vertex pairs of `quads`, which must be on curves that `after` lacks
/// \param before, after  feature curves of `input` that `quads` has, and those it is to have
/// \param crossed  edges that guides cross; the strip's own follow
/// \return false if there is no such strip: nothing has changed then
bool insert_ring(QuadMesh& quads, std::vector<GuideEdge>& crossed, int guide, const std::vector<std::array<int, 2>>& chain,
                 const TriangleMesh& input, const FeatureGraph& before, const FeatureGraph& after);

/// Moves vertices on some curves, also those where such curves meet, so that the curves are as near to their chains of edges as
/// they can be: by less than a third of an edge, along the curve to where it bends and off it to its outer side, and not
/// where quads would suffer. Feature edges must be in the order of the curves.
/// \param chosen  #curves  \param rings  edges whose ends stay where they are
void fit_to_curves(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const std::vector<char>& chosen,
                   const std::vector<GuideEdge>& rings);

/// Moves free vertices of edges that guides cross: both ends of an edge alike, so that the guides go through the middles (the
/// last bit that smoothing leaves, and the height that the surface's curvature puts between a chord and the surface); then
/// along the guides, by at most half an edge and not where quads would suffer, so that they cross at right angles.
void centre_on_guides(QuadMesh& quads, const std::vector<GuideEdge>& rings, const std::vector<StrokeTrace>& traces);

/// How near a mesh comes to what a guide asks, in edge lengths.
struct GuideFit {
  double length = 0;       ///< of the guide on the surface (scene units)
  double edge_length = 0;  ///< mean, of the edges of a loop, or of all sides of a ring's quads (scene units)
  double distance = 0;     ///< largest, of a loop: from the guide to the chain; of a ring: from the edges' middles to it
  double angle = 0;        ///< of a ring: largest deviation from a right angle (degrees)
  bool is_connected = false;  ///< the edges are one chain (one strip) for each run of the guide
  int edges = 0;

  static constexpr double kNear = 0.1;  ///< a guide that is met is as near as that (edge lengths)
};

/// \param chains  edges that follow guides  \param rings  edges that guides cross
GuideFit measure_loop(const StrokeTrace& trace, const QuadMesh& quads, const std::vector<GuideEdge>& chains, int guide);
GuideFit measure_ring(const StrokeTrace& trace, const QuadMesh& quads, const std::vector<GuideEdge>& rings, int guide);

}  // namespace hybrid_quad
