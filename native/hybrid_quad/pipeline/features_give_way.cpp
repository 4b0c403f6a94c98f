#include "hybrid_quad/pipeline/features_give_way.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "hybrid_quad/features/features_with_room.h"
#include "hybrid_quad/mesh/segment_index.h"

namespace hybrid_quad {

namespace {

// Edges that features must have, over quads: up to the first number all stay; where there are more, they give way down to
// the second.
constexpr double kTooCrowded = 0.45, kRoomy = 0.3;
// Up to this number all may have their edges, in quads that are long and thin.
constexpr double kInReach = 1;
// The same of edges shorter than quads, and how far all give way where these are too many.
constexpr double kTooShort = 0.02, kHardlyAnyShort = 0.006, kAiry = 0.15;

constexpr double kOpen = 1, kClosed = 4;  ///< edges that a curve must have
constexpr double kGaps[] = {0.15, 0.2, 0.3, 0.4, 0.55, 0.75, 1, 1.3};  ///< between features, in usual lengths

double length_of(const TriangleMesh& mesh, const FeatureCurve& curve) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
    sum += (mesh.position(curve.vertices[i + 1]) - mesh.position(curve.vertices[i])).norm();
  return sum;
}

/// Edges that features must have, over the number of quads: every curve one, closed ones four, long ones as many as edges
/// of four times the usual length make. \param length  the usual one
double crowding(const TriangleMesh& mesh, const FeatureGraph& features, double quads, double length) {
  constexpr double kLongest = 4;
  double edges = 0;
  for (const FeatureCurve& curve : features.curves)
    edges += std::max(curve.closed ? kClosed : kOpen, length_of(mesh, curve) / (kLongest * length));
  return edges / quads;
}

/// Edges shorter than the usual length that features must have, over the number of quads, each by how much it is shorter.
double shortness(const TriangleMesh& mesh, const FeatureGraph& features, double quads, double length) {
  double edges = 0;
  for (const FeatureCurve& curve : features.curves)
    edges += std::max(0.0, (curve.closed ? kClosed : kOpen) - length_of(mesh, curve) / length);
  return edges / quads;
}

double total_length(const ComponentPlan& plan) {
  double sum = 0;
  for (const FeatureCurve& curve : plan.features.curves) sum += length_of(plan.mesh, curve);
  return sum;
}

/// Takes away the half-edges that do not remain, and counts their curves.
void take_features_away(ComponentPlan& plan, const std::vector<char>& remains) {
  enum Fate : char { kStays, kGone, kMarkedAndGone };
  std::vector<Fate> fate(plan.features.curves.size(), kStays);
  for (int h = 0; h < plan.mesh.halfedge_count(); ++h) {
    if (!plan.features.is_feature(h) || remains[h]) continue;
    Fate& of_curve = fate[plan.features.halfedge_curve[h]];
    of_curve = std::max(of_curve, plan.is_given[h] ? kMarkedAndGone : kGone);
    plan.is_given[h] = 0;
  }
  plan.given_way += static_cast<int>(std::count(fate.begin(), fate.end(), kGone));
  plan.marks_given_way += static_cast<int>(std::count(fate.begin(), fate.end(), kMarkedAndGone));
  plan.features = trace_features(plan.mesh, remains, corners_for_quads(plan.length), plan.corners);
}

/// \param is_firm  3 #F  \returns it with the features that somebody wants a number of quads along
std::vector<char> with_counted(const ComponentPlan& plan, std::vector<char> is_firm) {
  for (int h = 0; h < plan.mesh.halfedge_count(); ++h)
    if (plan.features.is_feature(h) && plan.features.curves[plan.features.halfedge_curve[h]].asked_count > 0) is_firm[h] = 1;
  return is_firm;
}

/// Half-edges of features that do not give way to others: those that somebody marked, or wants a number of quads along.
std::vector<char> firm_features(const ComponentPlan& plan) { return with_counted(plan, plan.is_given); }

/// \param is_firm  3 #F  \returns it with the boundary
std::vector<char> with_boundary(const ComponentPlan& plan, std::vector<char> is_firm) {
  for (int h = 0; h < plan.mesh.halfedge_count(); ++h)
    if (plan.features.is_feature(h) && plan.mesh.opposite(h) < 0) is_firm[h] = 1;
  return is_firm;
}

/// Takes features away that pass near some places, but not the boundary.
/// \param is_firm  3 #F: what else stays  \param reach  of an edge: how near is near
template <class Reach>
void take_away_at(ComponentPlan& plan, const std::vector<Vector3>& places, const std::vector<char>& is_firm, const Reach& reach) {
  std::vector<char> remains = with_boundary(plan, is_firm);
  for (int h = 0; h < plan.mesh.halfedge_count(); ++h) {
    if (remains[h] || !plan.features.is_feature(h)) continue;
    const int a = plan.mesh.from(h), b = plan.mesh.to(h);
    const double near = reach(a, b);
    remains[h] = std::none_of(places.begin(), places.end(), [&](const Vector3& p) {
      return nearest_on_segment(p, {plan.mesh.position(a), plan.mesh.position(b)}).squared_distance < near * near;
    });
  }
  take_features_away(plan, remains);
}

/// Takes features away, by ever wider gaps between those that stay, until there is room. \returns whether any
template <class HasRoom>
bool widen_gaps(ComponentPlan& plan, double length, const RunContext& context, const HasRoom& has_room) {
  const std::vector<char> is_kept = firm_features(plan);
  std::vector<char> remains;
  for (const double gap : kGaps) {
    remains = features_with_room(plan.mesh, plan.features, is_kept, gap * length, context);
    if (has_room(trace_features(plan.mesh, remains, corners_for_quads(plan.length), plan.corners))) break;
  }
  const int before = plan.given_way;
  take_features_away(plan, remains);
  return plan.given_way > before;
}

bool is_sharp(const ComponentPlan& plan, int h) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  const Vector3 a = plan.mesh.normal(h / 3), b = plan.mesh.normal(plan.mesh.opposite(h) / 3);
  return plan.sharp_angle > 0 && std::atan2(a.cross(b).norm(), a.dot(b)) > plan.sharp_angle * kDegree;
}

double usual_length(const ComponentPlan& plan) { return std::sqrt(plan.mesh.total_area() / plan.quads); }

}  // namespace

void merge_double_lines(ComponentPlan& plan, double length, const RunContext& context) {
  constexpr double kGap = 0.05;
  take_features_away(plan, features_with_room(plan.mesh, plan.features, plan.is_given, kGap * length, context));
  // What is left lies on top of itself, as the rim of a flap does, where the surface is smaller than a strip along it.
  if (total_length(plan) * kGap * length > plan.mesh.total_area()) take_features_away(plan, with_boundary(plan, plan.is_given));
}

bool make_room(ComponentPlan& plan, const RunContext& context) {
  const double length = usual_length(plan);
  const auto crowding_of = [&](const FeatureGraph& features) { return crowding(plan.mesh, features, plan.quads, length); };
  const double before = crowding_of(plan.features);
  plan.was_crowded = before > kTooCrowded;
  if (!plan.was_crowded) return false;
  auto with_all = before <= kInReach ? std::make_shared<const ComponentPlan>(plan) : nullptr;
  if (!widen_gaps(plan, length, context, [&](const FeatureGraph& fewer) { return crowding_of(fewer) <= kRoomy; })) return false;
  plan.with_all = std::move(with_all);
  return true;
}

bool make_room_for_shapes(ComponentPlan& plan, const RunContext& context) {
  const double length = usual_length(plan);
  const auto shortness_of = [&](const FeatureGraph& features) { return shortness(plan.mesh, features, plan.quads, length); };
  const bool is_cramped = plan.was_crowded || shortness_of(plan.features) > kTooShort;
  return is_cramped && widen_gaps(plan, length, context, [&](const FeatureGraph& fewer) {
           return shortness_of(fewer) <= kHardlyAnyShort && crowding(plan.mesh, fewer, plan.quads, length) <= kAiry;
         });
}

bool let_angles_go(ComponentPlan& plan) {
  const int before = plan.given_way;
  take_features_away(plan, with_boundary(plan, firm_features(plan)));
  return plan.given_way > before;
}

bool make_room_at(ComponentPlan& plan, const std::vector<Vector3>& places) {
  const int before = plan.given_way;
  take_away_at(plan, places, firm_features(plan), [&](int a, int b) { return std::max(plan.target[a], plan.target[b]); });
  return plan.given_way > before;
}

bool make_room_in_marks_at(ComponentPlan& plan, const std::vector<Vector3>& places, double reach) {
  const int before = plan.given_way + plan.marks_given_way;
  take_away_at(plan, places, with_counted(plan, std::vector<char>(plan.mesh.halfedge_count(), 0)),
               [&](int a, int b) { return reach * std::max(plan.needed[a], plan.needed[b]); });
  return plan.given_way + plan.marks_given_way > before;
}

bool let_exact_wishes_go(ComponentPlan& plan, const HardGuides& guides) {
  const bool has_guides = !plan.guides.empty();
  bool has_counts = false;
  if (has_guides) {
    std::vector<char> remains = with_boundary(plan, with_counted(plan, std::vector<char>(plan.mesh.halfedge_count(), 0)));
    for (int h = 0; h < plan.mesh.halfedge_count(); ++h)
      if (!remains[h] && plan.features.is_feature(h))
        remains[h] = plan.guides[h] < 0 || guides.sets[plan.guides[h]].is_marked || is_sharp(plan, h);
    take_features_away(plan, remains);
    plan.guides.clear();
  }
  for (FeatureCurve& curve : plan.features.curves) {
    has_counts = has_counts || curve.asked_count > 0;
    curve.asked_count = 0;
  }
  plan.asked_chains.clear();
  return has_guides || has_counts;
}

}  // namespace hybrid_quad
