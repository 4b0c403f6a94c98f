#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/features/features.h"
#include "hybrid_quad/mesh/quad_complex.h"
#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad {

/// Mirror planes through the origin: bit k stands for the plane on which coordinate k is zero.
using PlaneSet = std::uint8_t;
constexpr bool has_plane(PlaneSet planes, int axis) { return ((planes >> axis) & 1) != 0; }
constexpr PlaneSet plane(int axis) { return static_cast<PlaneSet>(1U << axis); }

/// How far a surface is from its own mirror image, in percent of its bounding box's diagonal.
struct PlaneDeviation {
  double largest = 0, mean = 0;
};

/// The deviation for each of the three coordinate planes, from evenly spread samples and the vertices. The same for any
/// number of threads.
std::array<PlaneDeviation, 3> plane_deviations(const TriangleMesh& mesh, const RunContext& context);

/// A part of a mesh, and what of the whole mesh everything in it was: enough to take any data along.
struct PositivePart {
  TriangleMesh mesh;
  /// Vertices of one face or edge of the whole with their weights; one vertex of weight 1 that was there before. A vertex
  /// of the whole may come several times, where the part has several fans.
  struct Origin {
    std::array<int, 3> vertex{-1, -1, -1};
    std::array<double, 3> weight{0, 0, 0};
    bool is_vertex() const { return vertex[1] < 0; }
  };
  std::vector<Origin> vertex;  ///< #V
  std::vector<int> halfedge;   ///< 3 #F: half-edge of the whole on which it lies, -1 inside a face
  std::vector<int> face;       ///< #F: face of the whole
  int faces_in_plane = 0;      ///< left out: they would lie on their own mirror images
};

/// The part of a mesh where the coordinates of all planes are positive. Vertices on a plane have that coordinate exactly
/// zero: those made by the cut, and those that were nearer than a small part of their edges, which move there. Faces
/// that lie in a plane go. The cut is boundary.
/// \throws InputError symmetry_plane_missed (the surface is on one side and has no edge on the plane) or
///         symmetry_side_empty (nothing on the positive side)
PositivePart positive_part(const TriangleMesh& mesh, PlaneSet planes);

/// Planes in which the boundary edge of half-edge h lies; none where h is no boundary.
PlaneSet planes_of_edge(const TriangleMesh& mesh, int h, PlaneSet planes);

/// Boundary vertices at which the planes of the boundary change: ends of seams. As corners they make every boundary curve
/// lie in one set of planes.
std::vector<int> seam_ends(const TriangleMesh& mesh, PlaneSet planes);

/// #curves: the planes in which all of a curve lies. \pre the seam ends are corners
std::vector<PlaneSet> seam_planes(const TriangleMesh& mesh, const FeatureGraph& features, PlaneSet planes);

/// Changes the quads of a part so that mirroring it gives an indexed mesh: no vertex inside a seam with one quad (its
/// mirror image would make two), and no other edge than the seam's own from seam to seam of one plane (it would lie on
/// its mirror image). Insets quads, and splits strips lengthwise.
/// \return how many changes \throws InternalError if a round limit passes
int open_seams(QuadComplex& complex, const std::vector<PlaneSet>& curve_planes);
/// The same for an indexed mesh. Vertices keep their numbers where nothing changes.
int open_seams(QuadMesh& mesh, const std::vector<PlaneSet>& curve_planes);

/// Moves free vertices that touch a plane, or are behind it, a little in front of it: they would touch their own images.
/// (The nearest point of a part may well lie on its cut.) \return how many
int keep_clear_of_planes(QuadMesh& mesh, PlaneSet planes);

/// The part and its mirror images as one mesh, welded along the seams. Mirror images have the same coordinates up to the
/// sign, bit for bit; those on a plane are zero. Copies of feature curves get numbers of their own. Seam edges are
/// feature edges of the whole only where `is_crease` holds, and vertices without feature edges become free.
/// \param is_crease  whether the surface is sharp at this seam edge of the part
/// \throws InternalError if a seam vertex is off its plane
QuadMesh mirror_quads(const QuadMesh& part, const std::vector<PlaneSet>& curve_planes, PlaneSet planes,
                      const std::vector<char>& is_crease);

/// #feature_edges of the part: whether it lies on a seam along which the mirrored surface bends by more than
/// `sharp_angle` degrees, or which is marked. \param mesh  the part's input \param marked  pairs of its vertices
std::vector<char> seam_creases(const QuadMesh& part, const std::vector<PlaneSet>& curve_planes, const TriangleMesh& mesh,
                               PlaneSet planes, double sharp_angle, const std::vector<std::array<int, 2>>& marked);

}  // namespace hybrid_quad
