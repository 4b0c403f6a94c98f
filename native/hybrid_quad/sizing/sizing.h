#pragma once

#include <vector>

#include "hybrid_quad/frame_field/frame_field.h"

namespace hybrid_quad {

struct SizingOptions {
  bool conformal = false;           ///< first scale by the conformal factor that makes the field integrable
  double conformal_clip = 2.0;      ///< bound of that factor, both ways
  bool correct_curl = true;         ///< curl correction by four parameters a face (curl_correction)
  double curl_weight = 1e-5;        ///< lambda: small = integrable frames, large = the asked frames
  double feature_weight = 30.0;     ///< keeps features isolines during the correction
  std::vector<double> direction_weight;  ///< #F or empty: how firmly frames keep their directions, 1 = as any
  /// #F or empty: symmetric maps of the faces' planes that take a unit frame's axes to a quad's edges, in target lengths.
  std::vector<Eigen::Matrix3d> stretch;
};

struct SizedFrames {
  FrameField field;
  double mean_correction = 0;  ///< rms |X - I| over the area
  int flipped_faces = 0;       ///< faces whose corrected frame was folded (det <= 0.2) and had to be moderated
};

/// Scales the unit frames to the surface's target lengths, corrects their curl, and rescales so that the area measured
/// in quads is what was asked (integral of 1 / h^2). Around curves with an asked count, frames are as long as that takes.
/// \param quads_asked  number of quads the whole surface should get; <= 0: from target lengths
SizedFrames apply_sizing(const WorkingSurface& surface, const FrameField& unit_frames, double quads_asked,
                         const SizingOptions& options, const RunContext& context);

/// Whether apply_sizing for another number of quads gives the same frames, scaled: curves with an asked count prevent that.
bool quads_only_scale(const WorkingSurface& surface);
/// Scales frames so that the area measured in quads is what is asked; as it is where that cannot be.
void scale_to_quads(const TriangleMesh& mesh, double quads, FrameField& field);

}  // namespace hybrid_quad
