#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hybrid_quad/frame_field/guide_map.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/sizing/sizing.h"
#include "hybrid_quad/sizing/thin_stretch.h"

namespace hybrid_quad {

constexpr double kMostFrameStretch = 10;  ///< longer over shorter axis of a frame

/// What the caller asks of places on one connected component. Each array may be empty.
struct Wishes {
  std::shared_ptr<const SurfaceIndex> index;          ///< of the component; null where nothing is asked
  GuideMap guides;                                    ///< the frames' directions too
  std::vector<std::array<Vector3, 2>> corner_frames;  ///< 3 #F, at the corners of the triangles; two zero vectors: none here
  std::vector<double> density;                        ///< #V, graded
  double most_stretch = 1;                            ///< longer over shorter side of the most anisotropic quad
};

/// Refuses what cannot be asked, before anything is computed.
/// \throws InputError wrong_count, non_finite_guide, non_finite_density, non_finite_frame, degenerate_frame, index_out_of_range,
/// non_finite_stroke; names the elements
void check_wishes(const PolygonSoup& soup, const RemeshOptions& options);

/// The caller's arrays but directions, which are by input vertex or input polygon, on a component of the built mesh.
/// \param vertex, face  #V, #F of the component: the vertex and the face of built.mesh
/// \param usual_length  quad edge length where nothing else is asked
/// \param chords  chord_lengths_on() the component
Wishes wishes_on(const TriangleMesh& component, const std::vector<int>& vertex, const std::vector<int>& face,
                 const BuiltMesh& built, const std::vector<std::array<int, 2>>& marked, const RemeshOptions& options,
                 double usual_length, const std::vector<double>& chords, const RunContext& context);

/// Adds the directions, which no length depends on; the index that they call for is left to the caller.
void add_directions(const TriangleMesh& component, const std::vector<int>& vertex, const std::vector<int>& face,
                    const BuiltMesh& built, const RemeshOptions& options, Wishes& wishes);

/// Lengths for options.chord_error. \param extent  of the whole surface  \return #V; empty where no such error is asked
std::vector<double> chord_lengths_on(const TriangleMesh& component, const std::vector<std::array<int, 2>>& marked,
                                     const RemeshOptions& options, double extent, const RunContext& context);

/// A working surface on which the shorter side of the most anisotropic quad is resolved, and coarser for many quads, unless
/// hard guides or lengths that are to vary need it finer (docs/decisions/0045).
/// \param quads  that the component is to get
WorkingSurfaceOptions working_surface_options(const Wishes& wishes, double quads, bool has_hard_guides);

/// What features are looked for, without marked edges. \param length  quad edge length
FeatureOptions feature_options(const RemeshOptions& options, double length);

/// The density on a finer mesh of the component, graded for quads of `length`. \return #V or empty
std::vector<double> density_on(const Wishes& wishes, const TriangleMesh& finer, double length, const RunContext& context);

/// The guides on a finer mesh of the component.
GuideMap guides_on(const Wishes& wishes, const TriangleMesh& finer);

/// How the field is to be solved on a working surface of the component.
FrameFieldOptions field_options(const WorkingSurface& surface, const Wishes& wishes, const RemeshOptions& options);

/// How firmly frames are to keep their directions when their lengths are made to fit. \return #F or empty, for SizingOptions
std::vector<double> direction_weights(const FrameFieldOptions& field);

/// How the unit frames are to be stretched: as the caller's frames are, or along the direction in which the surface bends
/// less, by at most options.anisotropy, or on thin parts by what is planned there. Areas stay. \return #F or empty, for SizingOptions
std::vector<Eigen::Matrix3d> stretch_of(const WorkingSurface& surface, const FrameField& unit_frames, const Wishes& wishes,
                                        const RemeshOptions& options, const ThinStretch& thin_stretch);

}  // namespace hybrid_quad
