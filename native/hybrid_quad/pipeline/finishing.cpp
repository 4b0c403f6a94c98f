#include "hybrid_quad/pipeline/finishing.h"

#include <cmath>

#include "hybrid_quad/assemble/feature_chains.h"
#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

namespace {

// Of the square root of the whole surface's area: smaller quads have no excuse to point against the surface; doubtful
// ones hardly any.
constexpr double kLeastSize = 0.009, kDoubtfulSize = 0.018;

}  // namespace

Finishing::Finishing(const ComponentPlan& plan, const SurfaceIndex& whole, const Wishes& wishes, const RemeshOptions& options)
    : plan_(plan), whole_(whole), asked_(options), guides_(guides_on(wishes, plan.mesh)) {
  constexpr double kAspectOfSizes = 0.45;  // nearer to squares, edges are nearer to the lengths asked for
  improve_.fit = options.fit;
  improve_.target_length = std::sqrt(plan.mesh.total_area() / plan.quads);
  improve_.usual_size = kDoubtfulSize * std::sqrt(whole.mesh().total_area());
  improve_.guides = &guides_;
  if (wishes.most_stretch > 1) improve_.aspect_power = 1;
  else if (!wishes.density.empty()) improve_.aspect_power = kAspectOfSizes;
}

ImproveReport Finishing::improve(QuadMesh& mesh, const RunContext& context) const {
  return improve_quads(mesh, plan_.mesh, plan_.features, *plan_.index, improve_, context, &whole_);
}

void Finishing::make_mirrorable(QuadMesh& mesh, const RunContext& context) const {
  if (asked_.symmetry.planes == 0) return;
  if (open_seams(mesh, plan_.curve_planes) > 0) {
    order_feature_edges(mesh, plan_.mesh, plan_.features);
    ImproveOptions o = improve_;
    o.edit_connectivity = false;
    o.guides = nullptr;
    if (asked_.improve) improve_quads(mesh, plan_.mesh, plan_.features, *plan_.index, o, context, &whole_);
    // What mends flawed quads changes connectivity in any case; there is no third round.
    if (open_seams(mesh, plan_.curve_planes) > 0) order_feature_edges(mesh, plan_.mesh, plan_.features);
  }
  keep_clear_of_planes(mesh, asked_.symmetry.planes);
}

std::vector<int> Finishing::flawed(const QuadMesh& mesh, int threads) const {
  return flawed_quads(mesh, whole_, kLeastSize * std::sqrt(whole_.mesh().total_area()), threads);
}

std::vector<int> Finishing::doubtful(const QuadMesh& mesh, int threads) const { return flawed_quads(mesh, whole_, improve_.usual_size, threads); }

}  // namespace hybrid_quad
