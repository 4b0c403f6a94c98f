#include "hybrid_quad/pipeline/finishing.h"

#include <utility>

#include <algorithm>
#include <cmath>

#include "hybrid_quad/assemble/feature_chains.h"
#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

namespace {

// Of the whole surface: so much of it has to agree with a quad that points against the surface nearest to it, and so much
// that there is no doubt. A judge sees no more than some hundred thousand points of the surface.
constexpr double kEnough = 2.5e-5, kNoDoubt = 6e-5;

/// Whether over much of a surface even squares that lie in its faces do not agree with it: where another sheet is in the same
/// place, no quad of that size can.
bool squares_fail(const TriangleMesh& mesh, const SurfaceIndex& whole, double edge, const Agreement& agreement) {
  constexpr int kSamples = 200;
  constexpr double kMuch = 0.25, kShort = 0.92;  // of the length asked for: not all quads are as large
  const double total = mesh.total_area();
  double area = 0;
  int taken = 0, failed = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    area += mesh.area(f);
    const int samples = static_cast<int>(std::lround(kSamples * area / total)) - taken;
    if (samples == 0) continue;
    taken += samples;
    const auto& t = mesh.face(f);
    const Vector3 centre = (mesh.position(t[0]) + mesh.position(t[1]) + mesh.position(t[2])) / 3;
    const Vector3 x = 0.5 * kShort * edge * mesh.normal(f).unitOrthogonal(), y = mesh.normal(f).cross(x);
    if (is_inverted({centre - x - y, centre + x - y, centre + x + y, centre - x + y}, whole, agreement)) failed += samples;
  }
  return failed > kMuch * kSamples;
}

/// Side of a square with the area that a quad gets.
double usual_edge(const ComponentPlan& plan) { return std::sqrt(plan.mesh.total_area() / plan.quads); }

/// What quads have to agree with is no more than what squares of their size do. Else all of them would count as flawed, and would
/// be changed for nothing.
Agreement most_that_squares_pass(const TriangleMesh& mesh, const SurfaceIndex& whole, double edge) {
  for (const double part : {kNoDoubt, kEnough}) {
    const Agreement agreement{part * whole.mesh().total_area()};
    if (!squares_fail(mesh, whole, edge, agreement)) return agreement;
  }
  return least_agreement(whole);
}

}  // namespace

Agreement least_agreement(const SurfaceIndex& whole) { return {kEnough * whole.mesh().total_area(), true}; }

Finishing::Finishing(const ComponentPlan& plan, const SurfaceIndex& whole, const Wishes& wishes, const RemeshOptions& options)
    : plan_(plan), whole_(whole), asked_(options), guides_(guides_on(wishes, plan.mesh)), futile_shapes_(usual_edge(plan)) {
  constexpr double kAspectOfSizes = 0.45;  // nearer to squares, edges are nearer to the lengths asked for
  constexpr double kWeightOfSizes = 3;
  improve_.fit = options.fit;
  improve_.target_length = usual_edge(plan);
  improve_.agreement = most_that_squares_pass(plan.mesh, whole, improve_.target_length);
  improve_.least_agreement = least_agreement(whole);
  improve_.guides = &guides_;
  if (wishes.most_stretch > 1 || plan.thin_stretch.is_any())
    improve_.aspect_power = 1;
  else if (!wishes.density.empty()) improve_.aspect_power = kAspectOfSizes;
  // What curvature, a chord error or frames ask for is held less firmly than what somebody painted: shape is worth more.
  if (!options.density.empty() && wishes.most_stretch <= 1) {
    improve_.asked_lengths = &plan.target;
    improve_.area_weight = std::max(improve_.area_weight, kWeightOfSizes * options.size_fidelity);
  }
}

Improved Finishing::improve_once(const QuadMesh& mesh, const RunContext& context) const {
  return hybrid_quad::improve_once(mesh, plan_.mesh, plan_.features, *plan_.index, improve_, context, &whole_);
}

ImproveReport Finishing::improve(QuadMesh& mesh, const RunContext& context, std::optional<Improved> first) const {
  return improve_quads(mesh, plan_.mesh, plan_.features, *plan_.index, improve_, context, &whole_, std::move(first));
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
  return flawed_quads(mesh, whole_, improve_.least_agreement, threads);
}

int Finishing::split_flawed(QuadMesh& mesh, const RunContext& context) const {
  const int splits =
      split_flawed_quads(mesh, plan_.mesh, plan_.features, *plan_.index, improve_, improve_.least_agreement, context, &whole_);
  if (splits > 0) settle_features(mesh);
  return splits;
}

int Finishing::refine_flawed(QuadMesh& mesh, const RunContext& context) const {
  const int places =
      refine_flawed_quads(mesh, plan_.mesh, plan_.features, *plan_.index, improve_, improve_.least_agreement, context, &whole_);
  if (places > 0) settle_features(mesh);
  return places;
}

int Finishing::reach_cut_parts(QuadMesh& mesh, const RunContext& context) const {
  const int places = hybrid_quad::reach_cut_parts(mesh, plan_.mesh, plan_.features, *plan_.index, improve_, context, &whole_);
  if (places > 0 && asked_.symmetry.planes != 0) keep_clear_of_planes(mesh, asked_.symmetry.planes);
  return places;
}

int Finishing::follow_creases(QuadMesh& mesh, const RunContext& context) const {
  if (!asked_.use_sharp_angle) return 0;
  const int places =
      hybrid_quad::follow_creases(mesh, plan_.mesh, plan_.features, *plan_.index, asked_.sharp_angle, improve_, context, &whole_);
  if (places > 0 && asked_.symmetry.planes != 0) keep_clear_of_planes(mesh, asked_.symmetry.planes);
  return places;
}

int Finishing::raise_shapes(QuadMesh& mesh, const RunContext& context) const {
  const int places = hybrid_quad::raise_shapes(mesh, plan_.mesh, plan_.features, *plan_.index, improve_, context, &whole_,
                                               &ended_searches_, &futile_shapes_);
  if (places > 0 && asked_.symmetry.planes != 0) keep_clear_of_planes(mesh, asked_.symmetry.planes);
  return places;
}

int Finishing::split_folded(QuadMesh& mesh, const RunContext& context) const {
  const int splits =
      split_folded_quads(mesh, plan_.mesh, plan_.features, *plan_.index, improve_, context, &whole_, &ended_searches_);
  if (splits > 0) settle_features(mesh);
  return splits;
}

/// After feature edges have been split.
void Finishing::settle_features(QuadMesh& mesh) const {
  order_feature_edges(mesh, plan_.mesh, plan_.features);
  if (asked_.symmetry.planes != 0) keep_clear_of_planes(mesh, asked_.symmetry.planes);
}

/// What agrees with enough for no doubt agrees with enough.
Doubts Finishing::doubts(const QuadMesh& mesh, int threads) const {
  Doubts found;
  found.doubtful = flawed_quads(mesh, whole_, improve_.agreement, threads);
  found.flawed = flawed_among(found.doubtful, mesh, whole_, improve_.least_agreement);
  return found;
}

}  // namespace hybrid_quad
