#include "hybrid_quad/pipeline/size_plan.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/mesh/edge_bisection.h"
#include "hybrid_quad/sizing/asked_lengths.h"

namespace hybrid_quad {

namespace {

constexpr double kMostStretch = 1.6;
constexpr double kMostGiving = 2;

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

/// How much longer edges are made than they were planned.
struct Stretch {
  double unlimited = 1;  ///< where nothing limits them
  double limited = 1;    ///< where features and thin parts do
};

std::vector<double> stretched(const ComponentPlan& plan, const Stretch& stretch) {
  std::vector<double> longer = plan.target;
  for (std::size_t v = 0; v < longer.size(); ++v) {
    const double most = stretch.unlimited * plan.unlimited[v];
    longer[v] = longer[v] >= plan.unlimited[v] ? most : std::min(most, stretch.limited * longer[v]);
  }
  const double longest = stretch.unlimited * *std::max_element(plan.unlimited.begin(), plan.unlimited.end());
  grade_lengths(plan.mesh, longest, longer, FeatureSizeOptions{}.growth * stretch.limited);
  return longer;
}

/// Lets curves that are to get more quads than fit have shorter ones. Longer ones need no finer triangles: the frames
/// see to that.
void shorten_for_counts(ComponentPlan& plan) {
  bool any = false;
  for (const FeatureCurve& curve : plan.features.curves) {
    if (curve.asked_count <= 0) continue;
    double length = 0;
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
      length += (plan.mesh.position(curve.vertices[i + 1]) - plan.mesh.position(curve.vertices[i])).norm();
    for (const int v : curve.vertices) plan.target[v] = std::min(plan.target[v], length / curve.asked_count);
    any = true;
  }
  if (any) grade_lengths(plan.mesh, *std::max_element(plan.target.begin(), plan.target.end()), plan.target);
}

double quads_of(const std::vector<ComponentPlan>& plans, const Stretch& stretch) {
  double sum = 0;
  for (const ComponentPlan& plan : plans) sum += quads_for_lengths(plan.mesh, stretched(plan, stretch));
  return sum;
}

/// The least stretch at which no more quads fit than were asked for, first of what is free to give way, then of the rest.
Stretch least_stretch(const std::vector<ComponentPlan>& plans, double quads_asked) {
  constexpr double kPrecision = 1.005;
  Stretch stretch;
  const auto widen = [&](double& value, double most) {
    double low = value, high = most;
    value = high;
    if (quads_of(plans, stretch) >= quads_asked) return false;
    while (high / low > kPrecision) {
      value = std::sqrt(low * high);
      (quads_of(plans, stretch) > quads_asked ? low : high) = value;
    }
    value = high;
    return true;
  };
  if (!widen(stretch.unlimited, kMostStretch)) widen(stretch.limited, kMostGiving);
  return stretch;
}

}  // namespace

ComponentPlan plan_component(const TriangleMesh& mesh, double length, const std::vector<std::array<int, 2>>& marked,
                             const std::vector<CountedChain>& chains, const Wishes& wishes,
                             const RemeshOptions& options, const RunContext& context) {
  // Lengths and thickness are known at vertices: these must not be too far apart. Against the size of the component they
  // are near enough, however small the quads: a few ten thousand triangles tell.
  constexpr double kLongestEdge = 0.8, kNearEnough = 0.01, kTiny = 0.7, kTinyRatio = 0.8;
  context.checkpoint();
  ComponentPlan plan;
  plan.length = std::min(length, std::sqrt(area_by_density(mesh, wishes.density) / least_quads(mesh)));
  const double most_density = wishes.density.empty() ? 1 : *std::max_element(wishes.density.begin(), wishes.density.end());
  const double longest = std::max(kLongestEdge * plan.length / most_density, kNearEnough * std::sqrt(mesh.total_area()));
  std::vector<EdgeSet> chain_edges;
  for (const CountedChain& chain : chains) chain_edges.push_back(chain.edges);
  BisectedMesh fine = bisect_long_edges(mesh, longest, marked, chain_edges);
  context.checkpoint();
  plan.mesh = std::move(fine.mesh);
  FeatureOptions features = feature_options(options, plan.length);
  features.marked_edges = std::move(fine.marked_edges);
  features.corners = seam_ends(plan.mesh, options.symmetry.planes);
  std::vector<CountedChain> fine_chains = chains;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    fine_chains[i].edges = std::move(fine.chains[i]);
    for (const int v : chain_ends(fine_chains[i])) features.corners.push_back(v);
  }
  plan.features = detect_features(plan.mesh, features, context);
  plan.chains = plan_curve_counts(plan.mesh, fine_chains, plan.features);
  plan.curve_planes = seam_planes(plan.mesh, plan.features, options.symmetry.planes);
  const std::vector<double> density = density_on(wishes, plan.mesh, plan.length);
  plan.unlimited.assign(plan.mesh.vertex_count(), plan.length);
  for (std::size_t v = 0; v < density.size(); ++v) plan.unlimited[v] = plan.length / density[v];
  FeatureSizeOptions feature_size;
  // What is smaller than a quad is coarse anyhow: its own features may ask for little more than it takes to be a mesh.
  if (plan.length < kTiny * length) feature_size.least_ratio = kTinyRatio;
  plan.target = asked_lengths(SurfaceIndex(plan.mesh, {}), plan.features, plan.length, density, feature_size, context);
  shorten_for_counts(plan);
  plan.quads = quads_for_lengths(plan.mesh, plan.target);
  return plan;
}

void balance_plans(std::vector<ComponentPlan>& plans, double quads_asked) {
  constexpr double kEnough = 1.005;
  if (quads_of(plans, Stretch{}) <= quads_asked * kEnough) return;
  const Stretch stretch = least_stretch(plans, quads_asked);
  for (ComponentPlan& plan : plans) {
    plan.target = stretched(plan, stretch);
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
