#include "hybrid_quad/pipeline/size_plan.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/mesh/edge_bisection.h"
#include "hybrid_quad/sizing/asked_lengths.h"

namespace hybrid_quad {

namespace {

constexpr double kMostStretch = 1.6;

int boundary_loops(const TriangleMesh& mesh) {
  std::vector<char> seen(mesh.vertex_count(), 0);
  int loops = 0;
  for (int start = 0; start < mesh.vertex_count(); ++start) {
    if (seen[start] || !mesh.is_boundary_vertex(start)) continue;
    ++loops;
    for (int v = start; !seen[v]; v = mesh.to(mesh.outgoing(v))) seen[v] = 1;
  }
  return loops;
}

/// A component needs some quads to be a mesh at all, however small it is, and more for every handle and hole.
double least_quads(const TriangleMesh& mesh) {
  constexpr double kSphere = 16, kHandle = 32, kHole = 8;
  const int loops = boundary_loops(mesh);
  const double handles = (2.0 - mesh.euler_characteristic() - loops) / 2;
  return (loops > 0 ? 0 : kSphere) + kHandle * handles + kHole * loops;
}

/// Target lengths where everything that nothing limits is `factor` times as long.
std::vector<double> stretched(const ComponentPlan& plan, double factor) {
  std::vector<double> longer = plan.target;
  for (std::size_t v = 0; v < longer.size(); ++v)
    if (longer[v] >= plan.unlimited[v]) longer[v] = factor * plan.unlimited[v];
  grade_lengths(plan.mesh, factor * *std::max_element(plan.unlimited.begin(), plan.unlimited.end()), longer);
  return longer;
}

}  // namespace

ComponentPlan plan_component(const TriangleMesh& mesh, double length, const std::vector<std::array<int, 2>>& marked,
                             const Wishes& wishes, const RemeshOptions& options, const RunContext& context) {
  // Lengths and thickness are known at vertices: these must not be too far apart. Against the size of the component they
  // are near enough, however small the quads: a few ten thousand triangles tell.
  constexpr double kLongestEdge = 0.8, kNearEnough = 0.01, kTiny = 0.7, kTinyRatio = 0.8;
  context.checkpoint();
  ComponentPlan plan;
  plan.length = std::min(length, std::sqrt(area_by_density(mesh, wishes.density) / least_quads(mesh)));
  const double most_density = wishes.density.empty() ? 1 : *std::max_element(wishes.density.begin(), wishes.density.end());
  const double longest = std::max(kLongestEdge * plan.length / most_density, kNearEnough * std::sqrt(mesh.total_area()));
  BisectedMesh fine = bisect_long_edges(mesh, longest, marked);
  context.checkpoint();
  plan.mesh = std::move(fine.mesh);
  FeatureOptions features = feature_options(options, plan.length);
  features.marked_edges = std::move(fine.marked_edges);
  features.corners = seam_ends(plan.mesh, options.symmetry.planes);
  plan.features = detect_features(plan.mesh, features, context);
  plan.curve_planes = seam_planes(plan.mesh, plan.features, options.symmetry.planes);
  const std::vector<double> density = density_on(wishes, plan.mesh, plan.length);
  plan.unlimited.assign(plan.mesh.vertex_count(), plan.length);
  for (std::size_t v = 0; v < density.size(); ++v) plan.unlimited[v] = plan.length / density[v];
  FeatureSizeOptions feature_size;
  // What is smaller than a quad is coarse anyhow: its own features may ask for little more than it takes to be a mesh.
  if (plan.length < kTiny * length) feature_size.least_ratio = kTinyRatio;
  plan.target = asked_lengths(SurfaceIndex(plan.mesh, {}), plan.features, plan.length, density, feature_size, context);
  plan.quads = quads_for_lengths(plan.mesh, plan.target);
  return plan;
}

void balance_plans(std::vector<ComponentPlan>& plans, double quads_asked) {
  constexpr double kPrecision = 1.005;
  const auto total = [&](double factor) {
    double sum = 0;
    for (const ComponentPlan& plan : plans) sum += quads_for_lengths(plan.mesh, stretched(plan, factor));
    return sum;
  };
  if (total(1) <= quads_asked * kPrecision) return;
  double low = 1, high = kMostStretch;
  if (total(high) < quads_asked)
    while (high / low > kPrecision) {
      const double middle = std::sqrt(low * high);
      (total(middle) > quads_asked ? low : high) = middle;
    }
  for (ComponentPlan& plan : plans) {
    plan.target = stretched(plan, high);
    plan.quads = quads_for_lengths(plan.mesh, plan.target);
  }
}

ComponentPlan refined_plan(const ComponentPlan& plan, double quads_factor, const std::vector<LengthLimit>& limits) {
  ComponentPlan finer = plan;
  const double factor = 1 / std::sqrt(quads_factor);
  for (double& t : finer.target) t *= factor;
  if (!limits.empty()) {
    const double longest = *std::max_element(finer.target.begin(), finer.target.end());
    limit_lengths(SurfaceIndex(finer.mesh, {}), limits, finer.target);
    grade_lengths(finer.mesh, longest, finer.target);
  }
  finer.quads = quads_for_lengths(finer.mesh, finer.target);
  return finer;
}

}  // namespace hybrid_quad
