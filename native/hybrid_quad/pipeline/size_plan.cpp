#include "hybrid_quad/pipeline/size_plan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "hybrid_quad/features/crease_normals.h"
#include "hybrid_quad/mesh/edge_bisection.h"
#include "hybrid_quad/pipeline/features_give_way.h"
#include "hybrid_quad/pipeline/fewest_quads.h"
#include "hybrid_quad/sizing/asked_lengths.h"

namespace hybrid_quad {

namespace {

constexpr double kMostStretch = 1.6;
constexpr double kMostGiving = 2;

/// The set of hard guides on the edge of every half-edge, -1: none; empty where there are none at all.
std::vector<int> guides_on_edges(const TriangleMesh& mesh, const BisectedMesh& fine, const std::vector<int>& guides) {
  std::map<std::array<int, 2>, int> on_edge;
  for (std::size_t i = 0; i < fine.marked_edges.size(); ++i)
    if (fine.source[i] >= 0 && guides[fine.source[i]] >= 0) {
      const auto& [a, b] = fine.marked_edges[i];
      on_edge[{a, b}] = on_edge[{b, a}] = guides[fine.source[i]];
    }
  if (on_edge.empty()) return {};
  std::vector<int> found_guides(mesh.halfedge_count(), -1);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const auto found = on_edge.find({mesh.from(h), mesh.to(h)});
    if (found != on_edge.end()) found_guides[h] = found->second;
  }
  return found_guides;
}

/// Half-edges of the given edges, both sides.
std::vector<char> on_edges(const TriangleMesh& mesh, const std::vector<std::array<int, 2>>& edges) {
  std::set<std::array<int, 2>> given;
  for (const auto& [a, b] : edges) given.insert({std::min(a, b), std::max(a, b)});
  std::vector<char> found(mesh.halfedge_count(), 0);
  if (given.empty()) return found;
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    found[h] = given.count({std::min(mesh.from(h), mesh.to(h)), std::max(mesh.from(h), mesh.to(h))}) > 0;
  return found;
}

void add_corners(ComponentPlan& plan, const std::vector<int>& corners) {
  std::vector<char> is_feature(plan.mesh.halfedge_count());
  for (int h = 0; h < plan.mesh.halfedge_count(); ++h) is_feature[h] = plan.features.is_feature(h);
  plan.corners.insert(plan.corners.end(), corners.begin(), corners.end());
  plan.features = trace_features(plan.mesh, is_feature, corners_for_quads(plan.length), plan.corners);
}

/// Vertices at tight bends of hard guides become corners.
void add_guide_corners(ComponentPlan& plan) {
  std::vector<char> on_guide(plan.features.curves.size(), 0);
  for (int h = 0; h < plan.mesh.halfedge_count(); ++h)
    if (plan.features.is_feature(h) && plan.guides[h] >= 0) on_guide[plan.features.halfedge_curve[h]] = 1;
  const std::vector<int> corners = tight_bends(plan.mesh, plan.features, on_guide, plan.length);
  if (!corners.empty()) add_corners(plan, corners);
}

/// How much longer edges are made than they were planned.
struct Stretch {
  double unlimited = 1;  ///< where nothing limits them
  double limited = 1;    ///< where features and thin parts do
};

std::vector<double> stretched(const ComponentPlan& plan, const Stretch& stretch, const RunContext& context) {
  std::vector<double> longer = plan.target;
  for (std::size_t v = 0; v < longer.size(); ++v) {
    const double most = stretch.unlimited * plan.unlimited[v];
    longer[v] = longer[v] >= plan.unlimited[v] ? most : std::min(most, stretch.limited * longer[v]);
  }
  const double longest = stretch.unlimited * *std::max_element(plan.unlimited.begin(), plan.unlimited.end());
  grade_lengths(plan.mesh, longest, longer, FeatureSizeOptions{}.growth * stretch.limited, context);
  return longer;
}

/// Lets curves that are to get more quads than fit have shorter ones. Longer ones need no finer triangles: the frames
/// see to that. What would take quads a thousandth as long as usual is not asked for: the report tells that it is missed.
void shorten_for_counts(ComponentPlan& plan, const RunContext& context) {
  constexpr double kLeast = 1e-3;
  bool any = false;
  for (FeatureCurve& curve : plan.features.curves) {
    if (curve.asked_count <= 0) continue;
    double length = 0;
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
      length += (plan.mesh.position(curve.vertices[i + 1]) - plan.mesh.position(curve.vertices[i])).norm();
    if (length < kLeast * plan.length * curve.asked_count) {
      curve.asked_count = 0;
      continue;
    }
    for (const int v : curve.vertices) plan.target[v] = std::min(plan.target[v], length / curve.asked_count);
    any = true;
  }
  if (!any) return;
  const double longest = *std::max_element(plan.target.begin(), plan.target.end());
  grade_lengths(plan.mesh, longest, plan.target, FeatureSizeOptions{}.growth, context);
}

/// The lengths alone, for features and thin places as they are known.
void plan_lengths_again(ComponentPlan& plan, const RunContext& context) {
  FeatureSizeOptions feature_size;
  feature_size.least_ratio = plan.least_ratio;
  feature_size.thin_ratio = plan.thin_ratio;
  plan.target = asked_lengths(*plan.index, plan.features, plan.length, plan.density, *plan.thin_places, feature_size, context);
  shorten_for_counts(plan, context);
  plan.needed = plan.target;
  plan.quads = quads_for_lengths(plan.mesh, plan.target);
}

/// Everything about the lengths of edges that the features decide.
void plan_lengths(ComponentPlan& plan, PlaneSet mirror_planes, const RunContext& context) {
  plan.chains = plan_curve_counts(plan.mesh, plan.asked_chains, plan.features);
  plan.curve_planes = seam_planes(plan.mesh, plan.features, mirror_planes);
  plan.index = std::make_shared<const SurfaceIndex>(plan.mesh, plan.features.face_region, context);
  if (!plan.thin_places) plan.thin_places = thin_places(*plan.index, longest_asked(plan.length, plan.density), context);
  plan_lengths_again(plan, context);
}

/// The halves of a sliver are as wide, but not as long, and may seem to be none: they have the normal of the whole one.
std::vector<Vector3> crease_normals_of_parts(const TriangleMesh& whole, const std::vector<int>& face_source) {
  const std::vector<Vector3> of_whole = crease_normals(whole);
  std::vector<Vector3> normals;
  normals.reserve(face_source.size());
  for (const int f : face_source) normals.push_back(of_whole[f]);
  return normals;
}

double quads_of(const std::vector<ComponentPlan>& plans, const Stretch& stretch, const RunContext& context) {
  double sum = 0;
  for (const ComponentPlan& plan : plans) sum += quads_for_lengths(plan.mesh, stretched(plan, stretch, context));
  return sum;
}

/// The least stretch at which no more quads fit than were asked for, first of what is free to give way, then of the rest.
Stretch least_stretch(const std::vector<ComponentPlan>& plans, double quads_asked, const RunContext& context) {
  constexpr double kPrecision = 1.005;
  Stretch stretch;
  const auto widen = [&](double& value, double most) {
    double low = value, high = most;
    value = high;
    if (quads_of(plans, stretch, context) >= quads_asked) return false;
    while (high / low > kPrecision) {
      value = std::sqrt(low * high);
      (quads_of(plans, stretch, context) > quads_asked ? low : high) = value;
    }
    value = high;
    return true;
  };
  if (!widen(stretch.unlimited, kMostStretch)) widen(stretch.limited, kMostGiving);
  return stretch;
}

/// The plan for as many quads after some features were taken away. \param take_away  from a plan; returns whether any
template <class TakeAway>
ComponentPlan with_fewer_features(const ComponentPlan& plan, PlaneSet mirror_planes, const RunContext& context,
                                  const TakeAway& take_away) {
  ComponentPlan fewer = plan;
  fewer.part = -1;
  if (!take_away(fewer)) return fewer;
  plan_lengths(fewer, mirror_planes, context);
  scale_plan(fewer, plan.quads / fewer.quads);
  return fewer;
}

}  // namespace

ComponentPlan plan_component(const TriangleMesh& mesh, double length, const MarkedEdges& marked,
                             const std::vector<CountedChain>& chains, const Wishes& wishes,
                             const RemeshOptions& options, const RunContext& context) {
  // Lengths and thickness are known at vertices: these must not be too far apart. Against the size of the component they
  // are near enough, however small the quads: a few ten thousand triangles tell.
  constexpr double kLongestEdge = 1.25, kLongestWhereAsked = 0.8, kNearEnough = 0.01, kScarce = 0.7, kScarceRatio = 0.8;
  constexpr double kPieces = 2e4, kPiecesPerQuad = 4;  // most edges that halved ones may become
  // Halves of a needle are three needles, so that a surface thin as a hair becomes far more pieces than its edges do.
  constexpr double kSplitsPerPiece = 2;
  context.checkpoint();
  ComponentPlan plan;
  const double area = area_by_density(mesh, wishes.density);
  plan.length = std::sqrt(area / std::max(area / (length * length), least_to_plan(mesh)));
  const double most_density = wishes.density.empty() ? 1 : *std::max_element(wishes.density.begin(), wishes.density.end());
  const bool is_guided = std::any_of(marked.guides.begin(), marked.guides.end(), [](int set) { return set >= 0; });
  const double longest_edge = is_guided || !wishes.density.empty() ? kLongestWhereAsked : kLongestEdge;
  const double wanted = std::max(longest_edge * plan.length / most_density, kNearEnough * std::sqrt(mesh.total_area()));
  const double most_pieces = kPieces + kPiecesPerQuad * mesh.total_area() / (plan.length * plan.length);
  const double longest = affordable_length(mesh, wanted, most_pieces);
  std::vector<EdgeSet> chain_edges;
  for (const CountedChain& chain : chains) chain_edges.push_back(chain.edges);
  BisectedMesh fine = bisect_long_edges(mesh, longest, marked.ends, chain_edges, kSplitsPerPiece * most_pieces);
  context.checkpoint();
  plan.mesh = std::move(fine.mesh);
  plan.guides = guides_on_edges(plan.mesh, fine, marked.guides);
  FeatureOptions features = feature_options(options, plan.length);
  plan.is_given = on_edges(plan.mesh, fine.marked_edges);
  features.marked_edges = std::move(fine.marked_edges);
  features.corners = seam_ends(plan.mesh, options.symmetry.planes);
  plan.asked_chains = chains;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    plan.asked_chains[i].edges = std::move(fine.chains[i]);
    for (const int v : chain_ends(plan.asked_chains[i])) features.corners.push_back(v);
  }
  plan.corners = features.corners;
  plan.features = detect_features(plan.mesh, crease_normals_of_parts(mesh, fine.face_source), features, context);
  plan.sharp_angle = plan.features.sharp_angle;
  plan.given_way = plan.features.left_out;
  if (features.use_sharp_angle) merge_double_lines(plan, plan.length / most_density, context);
  if (!plan.guides.empty()) add_guide_corners(plan);
  plan.density = density_on(wishes, plan.mesh, plan.length, context);
  plan.unlimited.assign(plan.mesh.vertex_count(), plan.length);
  for (std::size_t v = 0; v < plan.density.size(); ++v) plan.unlimited[v] = plan.length / plan.density[v];
  // What is smaller than a quad is coarse anyhow: its own features may ask for little more than it takes to be a mesh.
  plan.is_scarce = std::sqrt(area / quads_for_topology(mesh)) < kScarce * length;
  plan.least_ratio = plan.thin_ratio = plan.is_scarce ? kScarceRatio : FeatureSizeOptions{}.least_ratio;
  plan_lengths(plan, options.symmetry.planes, context);
  return plan;
}

void balance_plans(std::vector<ComponentPlan>& plans, double quads_asked, const RunContext& context) {
  constexpr double kEnough = 1.005;
  if (quads_of(plans, Stretch{}, context) <= quads_asked * kEnough) return;
  const Stretch stretch = least_stretch(plans, quads_asked, context);
  for (ComponentPlan& plan : plans) {
    plan.target = stretched(plan, stretch, context);
    plan.quads = quads_for_lengths(plan.mesh, plan.target);
  }
}

bool make_room_for_count(std::vector<ComponentPlan>& plans, double quads_asked, PlaneSet mirror_planes, const RunContext& context) {
  bool any = false;
  for (ComponentPlan& plan : plans) any |= make_room(plan, context);
  if (!any) return false;
  for (ComponentPlan& plan : plans) plan_lengths(plan, mirror_planes, context);
  balance_plans(plans, quads_asked, context);
  return true;
}

ComponentPlan with_corners(const ComponentPlan& plan, const std::vector<int>& corners, PlaneSet mirror_planes,
                           const RunContext& context) {
  ComponentPlan with = plan;
  with.part = -1;
  add_corners(with, corners);
  plan_lengths(with, mirror_planes, context);
  scale_plan(with, plan.quads / with.quads);
  return with;
}

ComponentPlan with_room_for_thin_parts(const ComponentPlan& plan, double most_growth, bool is_by_count,
                                       const RunContext& context) {
  constexpr double kRatios[] = {0.13, 0.2, 0.25};
  const auto is_cramped = [&](const ThinPlace& place) { return place.length < plan.thin_ratio * plan.length; };
  if (std::none_of(plan.thin_places->begin(), plan.thin_places->end(), is_cramped)) return plan;
  const double most = most_growth * quads_for_lengths(plan.mesh, plan.unlimited);
  std::vector<ComponentPlan> finer{plan};
  finer[0].part = -1;
  for (const double ratio : kRatios) {
    if (ratio >= plan.thin_ratio) break;
    finer[0].thin_ratio = ratio;
    plan_lengths_again(finer[0], context);
    if (finer[0].quads > most) continue;
    if (is_by_count) {
      balance_plans(finer, plan.quads, context);
      scale_plan(finer[0], plan.quads / finer[0].quads);
    }
    return std::move(finer[0]);
  }
  return plan;
}

std::optional<ComponentPlan> with_long_quads(const ComponentPlan& plan, const ThinTubes& tubes, double most_growth,
                                             bool is_by_count, const RunContext& context) {
  constexpr double kMostStretch = 24, kMostOfWires = 4;
  constexpr double kLonger[] = {1, 1.5, 2, 3, 4, 6};  // times the usual length
  constexpr double kRatios[] = {0.05, 0.1, 0.2, 0.3};  // of the usual length: the shortest
  const auto planned = [&](double longer, double ratio) {
    ComponentPlan long_quads = plan;
    long_quads.part = -1;
    long_quads.length *= longer;
    for (double& length : long_quads.unlimited) length *= longer;
    long_quads.thin_stretch = {long_quads.length, kMostStretch};
    long_quads.thin_places = tubes.places;
    for (ThinPlace& place : *long_quads.thin_places) place.length = long_quads.thin_stretch.with_across(place.length);
    long_quads.thin_ratio = ratio / longer;
    plan_lengths_again(long_quads, context);
    return long_quads;
  };
  std::optional<ComponentPlan> least;
  for (const double longer : kLonger) {
    for (const double ratio : kRatios) {
      ComponentPlan tried = planned(longer, ratio);
      if (tried.quads <= most_growth * plan.quads) {
        if (is_by_count) scale_plan(tried, plan.quads / tried.quads);
        return tried;
      }
      if (!least || tried.quads < least->quads) least = std::move(tried);
    }
    if (!is_by_count) break;
  }
  return is_wire(tubes) && least->quads <= kMostOfWires * plan.quads ? std::move(least) : std::nullopt;
}

ComponentPlan with_room_for_shapes(const ComponentPlan& plan, PlaneSet mirror_planes, const RunContext& context) {
  return with_fewer_features(plan, mirror_planes, context, [&](ComponentPlan& without) { return make_room_for_shapes(without, context); });
}

ComponentPlan without_features_by_angle(const ComponentPlan& plan, PlaneSet mirror_planes, const RunContext& context) {
  return with_fewer_features(plan, mirror_planes, context, [](ComponentPlan& without) { return let_angles_go(without); });
}

ComponentPlan without_features_at(const ComponentPlan& plan, const std::vector<Vector3>& places, PlaneSet mirror_planes,
                                  const RunContext& context) {
  return with_fewer_features(plan, mirror_planes, context, [&](ComponentPlan& without) { return make_room_at(without, places); });
}

ComponentPlan without_marks_at(const ComponentPlan& plan, const std::vector<Vector3>& places, double reach,
                               PlaneSet mirror_planes, const RunContext& context) {
  return with_fewer_features(plan, mirror_planes, context,
                             [&](ComponentPlan& without) { return make_room_in_marks_at(without, places, reach); });
}

std::optional<ComponentPlan> without_exact_wishes(const ComponentPlan& plan, const HardGuides& guides, PlaneSet mirror_planes,
                                                  const RunContext& context) {
  if (plan.guides.empty() && plan.asked_chains.empty()) return std::nullopt;
  ComponentPlan without = plan;
  without.part = -1;
  if (!let_exact_wishes_go(without, guides)) return std::nullopt;
  plan_lengths(without, mirror_planes, context);
  scale_plan(without, std::min(1.0, plan.quads / without.quads));  // they may have called for more than fit without them
  return without;
}

void scale_plan(ComponentPlan& plan, double quads_factor) {
  for (double& length : plan.target) length /= std::sqrt(quads_factor);
  plan.thin_stretch.length /= std::sqrt(quads_factor);
  plan.quads *= quads_factor;
}

ComponentPlan refined_plan(const ComponentPlan& plan, double quads_factor, bool as_needed,
                           const std::vector<LengthLimit>& limits, const RunContext& context) {
  ComponentPlan finer = plan;
  finer.part = -1;
  const double factor = 1 / std::sqrt(quads_factor);
  finer.thin_stretch.length *= factor;
  for (std::size_t v = 0; v < finer.target.size(); ++v)
    finer.target[v] = factor * (as_needed ? std::min(plan.target[v], plan.needed[v]) : plan.target[v]);
  if (!limits.empty()) {
    const double longest = *std::max_element(finer.target.begin(), finer.target.end());
    limit_lengths(*finer.index, limits, finer.target);
    grade_lengths(finer.mesh, longest, finer.target, FeatureSizeOptions{}.growth, context);
  }
  finer.quads = quads_for_lengths(finer.mesh, finer.target);
  // Shorter edges at some places are paid for by the others.
  if (!as_needed) scale_plan(finer, quads_factor * plan.quads / finer.quads);
  return finer;
}

}  // namespace hybrid_quad
