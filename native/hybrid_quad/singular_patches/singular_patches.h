#pragma once

#include <vector>

#include "hybrid_quad/regular_quads/regular_quads.h"
#include "hybrid_quad/singular_patches/patch_quads.h"

namespace hybrid_quad {

/// One patch of the singular region with how it was filled.
struct FilledPatch {
  PatchQuads quads;
  int region = -1;             ///< FeatureGraph::face_region of its faces
  double area = 0;
  bool combinatorial = false;  ///< filled without the Morse-Smale complex
  std::vector<std::string> rejected;  ///< what the Morse-Smale quads violated, if they did
};

struct SingularPatches {
  std::vector<FilledPatch> patches;
  std::vector<int> piece_patch;  ///< overlay piece -> patch, -1 for pieces of regular quads
  double singular_area = 0;
  int released_cells = 0;  ///< regular quads given up because a patch next to them could not be filled
};

struct PatchOptions {
  double longest_edge = 0.4;   ///< refinement limit, in quads (paper 4.4)
  double persistence = 0.3;    ///< Morse-Smale pairs below this are cancelled
  int widening_rounds = 12;
};

/// Fills what the regular quads leave: the pieces of every patch are triangulated, refined with the phases of Psi, given
/// border extrema, and quadrangulated by the Morse-Smale complex; where that is no valid quad patch, combinatorially.
/// Arc and node ids are overlay half-edges (the first of the arc) and overlay vertices.
/// A patch with a border loop of fewer than four arcs takes the cells beside it in (they leave `regular`) until it has none
/// (patch_growth.h); one that cannot be filled takes all its neighbouring cells in and is tried again.
SingularPatches fill_singular_patches(const WorkingSurface& surface, const FrameField& frames,
                                      const SpanningParameterization& param,
                                      RegularQuads& regular, const PatchOptions& options, const RunContext& context);

}  // namespace hybrid_quad
