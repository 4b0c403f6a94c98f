#include "hybrid_quad/singular_patches/singular_patches.h"

#include "hybrid_quad/singular_patches/patch_growth.h"
#include "hybrid_quad/singular_patches/patch_room.h"
#include "hybrid_quad/singular_patches/patch_triangles.h"

namespace hybrid_quad {

namespace {

double area_of(const PatchSurface& patch) { return patch.mesh.total_area(); }

/// A patch has about as many quads as fit its area and its border. Many more come from a function that oscillates.
bool is_oversized(const PatchQuads& quads, double by_area) {
  int arcs = 0;
  for (const int arc : quads.arc) arcs += arc >= 0;
  return static_cast<double>(quads.quads.size()) > 2 * by_area + arcs;
}

FilledPatch fill_patch(const WorkingSurface& surface, const FrameField& frames, const SpanningParameterization& param,
                       const RegularQuads& regular, const std::vector<int>& pieces, const PatchOptions& options, const RunContext& context) {
  const int face = regular.overlay.piece_face[pieces.front()];
  const double length = surface.target_length[face];
  PatchTriangles triangles = triangulate_patch(regular.overlay, param, surface, frames, pieces);
  refine_patch(triangles, options.longest_edge, length, context);
  const PatchSurface patch = finish_patch(triangles, regular.overlay, length);
  FilledPatch out;
  out.region = surface.features.face_region[face];
  out.area = area_of(patch);
  try {
    out.quads = morse_smale_quads(patch, options.persistence, context);
    // Shapes that an indexed mesh can't hold are mended once the patch is in its place (repair_complex).
    out.rejected = structural_violations_of(out.quads, patch);
  } catch (const InternalError& error) {
    out.rejected.push_back(error.what());
  }
  if (out.rejected.empty() && is_oversized(out.quads, quads_by_area(surface, regular.overlay, pieces))) out.rejected.push_back("more quads than the patch has room for");
  if (!out.rejected.empty()) {
    out.combinatorial = true;
    out.quads = combinatorial_fill(patch, context);
    if (const auto violations = structural_violations_of(out.quads, patch); !violations.empty())
      throw InternalError("singular patches", violations.front());
  }
  return out;
}

}  // namespace

SingularPatches fill_singular_patches(const WorkingSurface& surface, const FrameField& frames,
                                      const SpanningParameterization& param,
                                      RegularQuads& regular, const PatchOptions& options, const RunContext& context) {
  SingularPatches out;
  for (int round = 0;; ++round) {
    out.released_cells += grow_over_short_loops(regular);
    out.patches.clear();
    out.singular_area = 0;
    const std::vector<std::vector<int>> patches = find_patches(regular);
    std::vector<int> failed;
    std::string reason;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      context.checkpoint(static_cast<double>(i) / static_cast<double>(patches.size()));
      try {
        out.patches.push_back(fill_patch(surface, frames, param, regular, patches[i], options, context));
        out.singular_area += out.patches.back().area;
      } catch (const InternalError& error) {
        failed.push_back(static_cast<int>(i));
        reason = error.what();
      }
    }
    if (failed.empty()) {
      out.piece_patch.assign(regular.overlay.piece_count(), -1);
      for (std::size_t i = 0; i < patches.size(); ++i)
        for (const int piece : patches[i]) out.piece_patch[piece] = static_cast<int>(i);
      return out;
    }
    const int released = round < options.widening_rounds ? grow(regular, patches, failed) : 0;
    if (released == 0) throw InternalError("singular patches", "a patch can't be filled: " + reason);
    out.released_cells += released;
  }
}

}  // namespace hybrid_quad
