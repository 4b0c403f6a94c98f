#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "hybrid_quad/mesh/edge_bisection.h"
#include "hybrid_quad/pipeline/count_budget.h"
#include "hybrid_quad/pipeline/remesh_components.h"
#include "hybrid_quad/pipeline/size_plan.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

ComponentPlan plan(const TriangleMesh& mesh, double length) {
  return plan_component(mesh, length, {}, {}, Wishes{}, RemeshOptions{}, RunContext{});
}

TEST(SizePlan, StretchesFreePartsForWhatNeedsMore) {
  // The slab's rims need shorter edges; the sphere has none to spare but its own.
  std::vector<ComponentPlan> plans{plan(test::box(10, Vector3(4, 4, 0.2)), 0.4), plan(test::icosphere(4), 0.4)};
  const double before = plans[0].quads + plans[1].quads;
  const double asked = 0.85 * before;
  balance_plans(plans, asked, RunContext{});
  EXPECT_NEAR(plans[0].quads + plans[1].quads, asked, 0.02 * asked);
  for (const ComponentPlan& p : plans)
    for (const double t : p.target) EXPECT_LE(t, 1.6 * p.length + 1e-12);
  // Rims keep what they need.
  const ComponentPlan alone = plan(test::box(10, Vector3(4, 4, 0.2)), 0.4);
  for (int v = 0; v < alone.mesh.vertex_count(); ++v) {
    EXPECT_GE(plans[0].target[v], alone.target[v] - 1e-12);
    if (alone.target[v] < 0.5 * alone.length) {
      EXPECT_NEAR(plans[0].target[v], alone.target[v], 1e-12);
    }
  }
}

TEST(SizePlan, ShortEdgesGiveWayOnlyWhereTheOthersCannot) {
  // Nearly all of a thin slab's quads are at its rims: these must give way too, but by no more than twice.
  const ComponentPlan alone = plan(test::box(10, Vector3(4, 0.3, 0.2)), 0.5);
  const double asked = 0.5 * alone.quads;
  std::vector<ComponentPlan> plans{alone};
  balance_plans(plans, asked, RunContext{});
  EXPECT_LE(plans[0].quads, 1.02 * asked);
  std::vector<ComponentPlan> hopeless{alone};
  balance_plans(hopeless, 1, RunContext{});
  for (int v = 0; v < alone.mesh.vertex_count(); ++v) EXPECT_LE(hopeless[0].target[v], 2 * alone.length + 1e-12);
  EXPECT_GT(hopeless[0].quads, alone.quads / 4.1);
}

TEST(SizePlan, LeavesRoomySurfacesAlone) {
  std::vector<ComponentPlan> plans{plan(test::icosphere(4), 0.2)};
  const std::vector<double> before = plans[0].target;
  balance_plans(plans, test::icosphere(4).total_area() / 0.04, RunContext{});
  EXPECT_EQ(plans[0].target, before);
}

TEST(SizePlan, RefinesWhereTold) {
  const ComponentPlan coarse = plan(test::icosphere(4), 0.3);
  const Vector3 pole(0, 0, 1);
  const ComponentPlan fine = refined_plan(coarse, 1.0, true, {{pole, 0.1}}, RunContext{});
  EXPECT_GT(fine.quads, coarse.quads);
  for (int v = 0; v < fine.mesh.vertex_count(); ++v) {
    EXPECT_LE(fine.target[v], coarse.target[v]);
    if (fine.mesh.position(v)[2] < -0.5) {
      EXPECT_DOUBLE_EQ(fine.target[v], coarse.target[v]);
    }
    if ((fine.mesh.position(v) - pole).norm() < 0.05) {
      EXPECT_LT(fine.target[v], 0.15);
    }
  }
  EXPECT_NEAR(refined_plan(coarse, 2.0, false, {}, RunContext{}).quads, 2 * coarse.quads, 1e-6 * coarse.quads);
}

TEST(SizePlan, ShorterEdgesAtPlacesAreNoReasonForMoreQuads) {
  const ComponentPlan coarse = plan(test::icosphere(4), 0.3);
  const ComponentPlan finer = refined_plan(coarse, 1.0, false, {{Vector3(0, 0, 1), 0.05}}, RunContext{});
  EXPECT_NEAR(finer.quads, coarse.quads, 1e-6 * coarse.quads);
  EXPECT_NEAR(quads_for_lengths(finer.mesh, finer.target), coarse.quads, 0.01 * coarse.quads);
  EXPECT_GT(refined_plan(coarse, 1.0, true, {{Vector3(0, 0, 1), 0.05}}, RunContext{}).quads, coarse.quads);
}

TEST(SizePlan, FeaturesByAngleGiveWayAroundAPlace) {
  const TriangleMesh cube = test::box(12, Vector3(4, 4, 4));
  const Vector3 corner = cube.position(0);
  const auto features_left = [&](const MarkedEdges& marked) {
    const ComponentPlan whole = plan_component(cube, 1.0, marked, {}, Wishes{}, RemeshOptions{}, RunContext{});
    const ComponentPlan fewer = without_features_at(whole, {corner}, 0, RunContext{});
    EXPECT_EQ(violations_of(fewer.features, fewer.mesh), std::vector<std::string>{});
    EXPECT_NEAR(fewer.quads, whole.quads, 1e-6 * whole.quads);
    int near = 0, far = 0, far_before = 0;
    for (int h = 0; h < fewer.mesh.halfedge_count(); ++h) {
      const double distance = std::max((fewer.mesh.position(fewer.mesh.from(h)) - corner).norm(), (fewer.mesh.position(fewer.mesh.to(h)) - corner).norm());
      if (fewer.features.is_feature(h)) ++(distance < 1 ? near : far);
      far_before += distance > 2 && whole.features.is_feature(h);
      EXPECT_LE(fewer.features.is_feature(h), whole.features.is_feature(h));
    }
    EXPECT_GE(far, far_before);
    EXPECT_EQ(fewer.given_way > whole.given_way, near == 0);
    return near;
  };
  EXPECT_EQ(features_left({}), 0);
  MarkedEdges all;
  for (int h = 0; h < cube.halfedge_count(); ++h)
    if (cube.opposite(h) < h && cube.normal(h / 3).dot(cube.normal(cube.opposite(h) / 3)) < 0.5) all.ends.push_back({cube.from(h), cube.to(h)});
  all.guides.assign(all.ends.size(), -1);
  EXPECT_GT(features_left(all), 0);
}

TEST(SizePlan, MarksGiveWayAroundAPlaceAtTheVeryLast) {
  const TriangleMesh cube = test::box(12, Vector3(4, 4, 4));
  const Vector3 corner = Vector3::Zero(), opposite(4, 4, 4);
  MarkedEdges all;
  for (int h = 0; h < cube.halfedge_count(); ++h)
    if (cube.opposite(h) < h && cube.normal(h / 3).dot(cube.normal(cube.opposite(h) / 3)) < 0.5)
      all.ends.push_back({cube.from(h), cube.to(h)});
  all.guides.assign(all.ends.size(), -1);
  const ComponentPlan whole = plan_component(cube, 1.0, all, {}, Wishes{}, RemeshOptions{}, RunContext{});
  int before = 0;
  for (const double reach : {0.1, 0.5, 2.0}) {
    const ComponentPlan fewer = without_marks_at(whole, {corner}, reach, 0, RunContext{});
    EXPECT_EQ(violations_of(fewer.features, fewer.mesh), std::vector<std::string>{});
    EXPECT_NEAR(fewer.quads, whole.quads, 1e-6 * whole.quads);
    EXPECT_EQ(fewer.marks_given_way, 3);
    EXPECT_EQ(fewer.given_way, whole.given_way);
    int gone = 0;
    for (int h = 0; h < fewer.mesh.halfedge_count(); ++h) {
      EXPECT_LE(fewer.is_given[h], fewer.features.is_feature(h));
      if (!whole.features.is_feature(h) || fewer.features.is_feature(h)) continue;
      ++gone;
      const double distance = std::min((fewer.mesh.position(fewer.mesh.from(h)) - corner).norm(),
                                       (fewer.mesh.position(fewer.mesh.to(h)) - corner).norm());
      EXPECT_LT(distance, 1.01 * reach);
    }
    EXPECT_GT(gone, before);
    before = gone;
    // What gave way is not taken back by what gives way after it.
    EXPECT_EQ(without_features_at(fewer, {opposite}, 0, RunContext{}).features.curves.size(), fewer.features.curves.size());
  }
}

TEST(SizePlan, TheBoundaryAndCountedCurvesNeverGiveWay) {
  const TriangleMesh grid = test::flat_grid(8, 8);
  MarkedEdges across;
  for (int h = 0; h < grid.halfedge_count(); ++h) {
    const Vector3 &a = grid.position(grid.from(h)), &b = grid.position(grid.to(h));
    if (a[1] == 0.5 && b[1] == 0.5 && a[0] < b[0]) across.ends.push_back({grid.from(h), grid.to(h)});
  }
  ASSERT_EQ(across.ends.size(), 8u);
  across.guides.assign(across.ends.size(), -1);
  const auto given_way = [&](const std::vector<CountedChain>& chains) {
    const ComponentPlan whole = plan_component(grid, 0.2, across, chains, Wishes{}, RemeshOptions{}, RunContext{});
    const ComponentPlan fewer = without_marks_at(whole, {grid.position(0)}, 100, 0, RunContext{});
    EXPECT_EQ(fewer.given_way, whole.given_way);
    for (int h = 0; h < fewer.mesh.halfedge_count(); ++h)
      EXPECT_TRUE(fewer.features.is_feature(h) || fewer.mesh.opposite(h) >= 0);
    return fewer.marks_given_way;
  };
  EXPECT_EQ(given_way({}), 1);
  EXPECT_EQ(given_way({{across.ends, 5}}), 0);
}

TEST(SizePlan, OfExactWishesWhatIsAFeatureBesidesStays) {
  const TriangleMesh box = test::box(8, Vector3(1, 1, 1));
  const auto edges_at = [&](double y, double z) {
    EdgeSet edges;
    for (int h = 0; h < box.halfedge_count(); ++h) {
      const Vector3 &a = box.position(box.from(h)), &b = box.position(box.to(h));
      if (a[1] == y && b[1] == y && a[2] == z && b[2] == z && a[0] < b[0]) edges.push_back({box.from(h), box.to(h)});
    }
    EXPECT_EQ(edges.size(), 8u);
    return edges;
  };
  enum { kGuide, kGuideOnMark, kGuideOnCrease, kCounted };
  const EdgeSet lines[] = {edges_at(0.25, 1), edges_at(0.5, 1), edges_at(1, 1), edges_at(0.75, 1)};
  MarkedEdges marked;
  for (const int line : {kGuide, kGuideOnMark, kGuideOnCrease})
    for (const auto& edge : lines[line]) {
      marked.ends.push_back(edge);
      marked.guides.push_back(line);
    }
  HardGuides guides;
  guides.sets = {{{0}, false, true}, {{0}, true, true}, {{0}, false, true}};
  const ComponentPlan whole = plan_component(box, 0.2, marked, {{lines[kCounted], 9}}, Wishes{}, RemeshOptions{}, RunContext{});
  const auto curve_along = [&](const ComponentPlan& p, int line) -> const FeatureCurve* {
    for (int h = 0; h < p.mesh.halfedge_count(); ++h)
      if (p.mesh.from(h) == lines[line][0][0] && p.mesh.to(h) == lines[line][0][1])
        return p.features.is_feature(h) ? &p.features.curves[p.features.halfedge_curve[h]] : nullptr;
    return nullptr;
  };
  for (const int line : {kGuide, kGuideOnMark, kGuideOnCrease, kCounted}) ASSERT_NE(curve_along(whole, line), nullptr) << line;
  EXPECT_EQ(curve_along(whole, kCounted)->asked_count, 9);
  const std::optional<ComponentPlan> without = without_exact_wishes(whole, guides, 0, RunContext{});
  ASSERT_TRUE(without);
  EXPECT_EQ(violations_of(without->features, without->mesh), std::vector<std::string>{});
  EXPECT_EQ(curve_along(*without, kGuide), nullptr);
  for (const int line : {kGuideOnMark, kGuideOnCrease, kCounted}) ASSERT_NE(curve_along(*without, line), nullptr) << line;
  EXPECT_EQ(curve_along(*without, kCounted)->asked_count, 0);
  EXPECT_EQ(without->marks_given_way, 1);
  EXPECT_LE(without->quads, whole.quads);
  EXPECT_FALSE(without_exact_wishes(*without, guides, 0, RunContext{})) << "nothing is left to let go";
}

TEST(SizePlan, FeaturesGiveWayWhereThereAreNearlyAsManyAsQuads) {
  const TriangleMesh slab = test::box(12, Vector3(4, 4, 0.1)), block = test::box(12, Vector3(4, 4, 1));
  bool has_another_plan = false;
  const auto features_of = [&](const TriangleMesh& box, double quads, const MarkedEdges& marked) {
    std::vector<ComponentPlan> plans{
        plan_component(box, std::sqrt(box.total_area() / quads), marked, {}, Wishes{}, RemeshOptions{}, RunContext{})};
    balance_plans(plans, quads, RunContext{});
    make_room_for_count(plans, quads, 0, RunContext{});
    EXPECT_EQ(violations_of(plans[0].features, plans[0].mesh), std::vector<std::string>{});
    EXPECT_EQ(plans[0].given_way > 0, plans[0].features.curves.size() < 12);
    if (const auto& all = plans[0].with_all) {
      EXPECT_GT(all->features.curves.size(), plans[0].features.curves.size());
      EXPECT_LT(all->given_way, plans[0].given_way);
      EXPECT_EQ(violations_of(all->features, all->mesh), std::vector<std::string>{});
    }
    has_another_plan = plans[0].with_all != nullptr;
    return plans[0].features.curves.size();
  };
  const auto features_for = [&](double quads, const MarkedEdges& marked) { return features_of(slab, quads, marked); };
  EXPECT_EQ(features_for(400, {}), 12u);
  EXPECT_FALSE(has_another_plan) << "none gave way";
  EXPECT_LT(features_for(16, {}), 12u);
  EXPECT_TRUE(has_another_plan) << "edges along all would be fewer than quads";
  EXPECT_LT(features_for(6, {}), 12u);
  EXPECT_LT(features_of(block, 6, {}), 12u);
  EXPECT_FALSE(has_another_plan) << "and beyond reach of six";
  MarkedEdges all;
  const FeatureGraph features = detect_features(slab, FeatureOptions{}, RunContext{});
  for (int h = 0; h < slab.halfedge_count(); ++h)
    if (features.is_feature(h) && slab.opposite(h) < h) all.ends.push_back({slab.from(h), slab.to(h)});
  all.guides.assign(all.ends.size(), -1);
  EXPECT_EQ(features_for(16, all), 12u);
  EXPECT_FALSE(has_another_plan);
}

TEST(SizePlan, ThinPartsGetRoomForFourQuadsAround) {
  // A sphere and on its top a rod.
  constexpr double kRadius = 0.05, kLength = 0.8, kArc = 3.1;
  const TriangleMesh tube = test::capped_cylinder(24, 160, 1, 1);
  std::vector<Vector3> positions = tube.positions();
  for (Vector3& p : positions) {
    const double s = 0.04 + p.z() * (kArc + kLength - 0.04), beyond = std::max(0.0, s - kArc);
    const double width = s < kArc ? std::max(kRadius, std::sin(s)) : kRadius;
    p = Vector3(width * p.x(), width * p.y(), (s < kArc ? -std::cos(s) : -std::cos(kArc)) + beyond);
  }
  const TriangleMesh mesh(std::move(positions), tube.faces());
  RemeshOptions options;
  options.use_sharp_angle = false;
  const auto plan_for = [&](double quads) {
    std::vector<ComponentPlan> plans{
        plan_component(mesh, std::sqrt(mesh.total_area() / quads), {}, {}, Wishes{}, options, RunContext{})};
    balance_plans(plans, quads, RunContext{});
    return plans[0];
  };
  const auto longest_on_rod = [](const ComponentPlan& plan) {
    double longest = 0;
    for (int v = 0; v < plan.mesh.vertex_count(); ++v)
      if (plan.mesh.position(v).z() > 1.3 && plan.mesh.position(v).z() < 1.7) longest = std::max(longest, plan.target[v]);
    return longest;
  };
  const double four_around = 2 * M_PI * kRadius / 4;
  const ComponentPlan plan = plan_for(130), roomy = with_room_for_thin_parts(plan, 1.5, true, RunContext{});
  EXPECT_GT(longest_on_rod(plan), 1.2 * four_around);
  EXPECT_LT(longest_on_rod(roomy), 1.2 * four_around);
  EXPECT_NEAR(roomy.quads, plan.quads, 1e-6 * plan.quads) << "others are longer for it";
  EXPECT_GT(*std::max_element(roomy.target.begin(), roomy.target.end()), *std::max_element(plan.target.begin(), plan.target.end()));
  const ComponentPlan fine = plan_for(5000);
  EXPECT_EQ(with_room_for_thin_parts(fine, 1.5, true, RunContext{}).target, fine.target) << "there is room";
  const ComponentPlan tiny = plan_for(20);
  EXPECT_EQ(with_room_for_thin_parts(tiny, 1.5, true, RunContext{}).target, tiny.target) << "it would take most of the quads";
}

TEST(ThinStretch, LengthsAreThoseOfSquaresWithAsMuchArea) {
  const ThinStretch stretch{2.0, 16};
  for (const double edge : {1e-3, 0.05, 0.125, 0.3, 1.0, 1.9, 2.0, 5.0}) {
    const double h = stretch.with_across(edge), ratio = stretch.ratio(h);
    EXPECT_NEAR(stretch.across(h), edge, 1e-12);
    EXPECT_NEAR(stretch.across(h) * ratio * edge, h * h, 1e-12) << "an edge along by an edge across";
    EXPECT_LE(ratio, 16);
    EXPECT_LE(ratio * edge, std::max(edge, 2.0) + 1e-12) << "edges along are no longer than usual";
  }
  EXPECT_FALSE(ThinStretch{}.is_any());
  EXPECT_EQ(ThinStretch{}.with_across(0.3), 0.3);
}

/// Along the z axis, of length 4.
TriangleMesh rod(int sides, double radius) { return test::capped_cylinder(sides, 200, radius, 4); }

TEST(ThinTubes, HaveAsFewSidesAsTheyLike) {
  for (const int sides : {4, 6, 8, 24}) {
    const TriangleMesh mesh = rod(sides, 0.02);
    const auto& ends = mesh.positions();
    const double middle = std::accumulate(ends.begin(), ends.end(), 0.0, [](double z, const Vector3& p) { return z + p.z(); }) /
                          mesh.vertex_count();
    const SurfaceIndex index(mesh, {}, RunContext{});
    const ThinTubes tubes = thin_tubes(index, 0.1, RunContext{});
    EXPECT_TRUE(is_wire(tubes)) << sides << " sides, " << tubes.share;
    EXPECT_TRUE(is_wire(index, 0.1, RunContext{}));
    for (const ThinPlace& place : tubes.places) {
      const Vector3& p = mesh.position(place.vertex);
      if (p.head<2>().norm() < 0.019 || std::abs(p.z() - middle) > 1.9) continue;  // where it ends
      EXPECT_LT(place.length, 1.05 * 2 * M_PI * 0.02 / 4);
      EXPECT_GT(place.length, 0.5 * 2 * M_PI * 0.02 / 4);
    }
    EXPECT_FALSE(is_wire(thin_tubes(index, 0.02, RunContext{}))) << "with room for four such quads around";
  }
  const TriangleMesh ball = test::icosphere(3);
  EXPECT_FALSE(is_wire(SurfaceIndex(ball, {}, RunContext{}), 0.3, RunContext{}));
}

TEST(SizePlan, WiresGetFourQuadsAroundForNoMoreQuads) {
  constexpr double kRadius = 0.02, kFourAround = 2 * M_PI * kRadius / 4;
  const TriangleMesh mesh = rod(8, kRadius);
  RemeshOptions options;
  options.use_sharp_angle = false;
  const auto tried = [&](double quads, bool is_by_count) {
    const ComponentPlan plan =
        plan_component(mesh, std::sqrt(mesh.total_area() / quads), {}, {}, Wishes{}, options, RunContext{});
    return with_long_quads(plan, thin_tubes(*plan.index, plan.length, RunContext{}), 1.0, is_by_count, RunContext{});
  };
  const auto longest_across = [](const ComponentPlan& plan) {
    double longest = 0;
    for (const double h : plan.target) longest = std::max(longest, plan.thin_stretch.across(h));
    return longest;
  };
  const std::optional<ComponentPlan> plan = tried(80, true);
  ASSERT_TRUE(plan);
  EXPECT_LT(longest_across(*plan), 1.2 * kFourAround);
  EXPECT_NEAR(plan->quads, 80, 4);
  EXPECT_GT(plan->thin_stretch.most, 1);
  const std::optional<ComponentPlan> few = tried(20, true);
  ASSERT_TRUE(few);
  EXPECT_LT(longest_across(*few), 1.2 * kFourAround);
  EXPECT_GT(few->quads, 20) << "four quads around come first";
  EXPECT_LE(few->quads, 80);
  const TriangleMesh ball = test::icosphere(3);
  const ComponentPlan round = plan_component(ball, 1, {}, {}, Wishes{}, options, RunContext{});
  EXPECT_FALSE(is_wire(thin_tubes(*round.index, round.length, RunContext{})));

  ComponentPlan finer = *plan;
  scale_plan(finer, 4);
  EXPECT_NEAR(finer.thin_stretch.ratio(finer.target[100]), plan->thin_stretch.ratio(plan->target[100]), 1e-9);
}

TEST(SizePlan, OfCreasesOnTopOfEachOtherOneStaysUnlessMarked) {
  // The rim of a plate that is a third of an edge length thick, a twenty-fifth, and a hundredth, which no angle tells from a fold.
  constexpr double kLength = 0.3;
  const auto curves_of = [](double thickness, bool is_marked) {
    const TriangleMesh plate = test::box(12, Vector3(4, 4, thickness));
    MarkedEdges marked;
    const FeatureGraph features = detect_features(plate, FeatureOptions{}, RunContext{});
    for (int h = 0; is_marked && h < plate.halfedge_count(); ++h)
      if (features.is_feature(h) && plate.opposite(h) < h) marked.ends.push_back({plate.from(h), plate.to(h)});
    marked.guides.assign(marked.ends.size(), -1);
    const ComponentPlan plan = plan_component(plate, kLength, marked, {}, Wishes{}, RemeshOptions{}, RunContext{});
    EXPECT_EQ(violations_of(plan.features, plan.mesh), std::vector<std::string>{});
    EXPECT_EQ(plan.given_way > 0, plan.features.curves.size() < 12);
    return plan.features.curves.size();
  };
  EXPECT_EQ(curves_of(0.1, false), 12u);
  for (const double thickness : {0.012, 0.003}) {
    EXPECT_LT(curves_of(thickness, false), 12u);
    EXPECT_GE(curves_of(thickness, false), 1u) << "one of the rims";
    EXPECT_EQ(curves_of(thickness, true), 12u);
  }
}

TEST(SizePlan, ACreaseWithSliversOnItIsOneCrease) {
  // Two squares at a right angle; their common side is two sides, with slivers between that lie in no plane of note. Cut
  // as short as quads are, their pieces are a hundred times wider for their length.
  const double aside = 5e-8;
  const auto crease_with = [&](bool has_two) {
    std::vector<Vector3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, aside, aside}};
    std::vector<std::array<int, 3>> faces{{0, 6, 2}, {6, 1, 3}, {6, 3, 2}};
    if (has_two) {
      points.push_back({0.5, -aside, 2 * aside});
      faces.insert(faces.end(), {{0, 1, 6}, {0, 7, 1}, {0, 4, 7}, {7, 4, 5}, {7, 5, 1}});
    } else {
      faces.insert(faces.end(), {{0, 1, 6}, {0, 4, 1}, {1, 4, 5}});
    }
    return TriangleMesh(points, faces);
  };
  for (const bool has_two : {false, true}) {
    const ComponentPlan p = plan(crease_with(has_two), 0.02);
    double length = 0;
    for (int h = 0; h < p.mesh.halfedge_count(); ++h)
      if (p.features.is_feature(h) && p.mesh.opposite(h) > h) length += p.mesh.edge_length(h);
    EXPECT_NEAR(length, 1, 1e-3) << has_two;
    EXPECT_EQ(p.given_way, 0) << has_two << ": nothing had to be taken away for that";
  }
}

TEST(CountBudget, WhatOneTakesTheOthersPay) {
  std::vector<ComponentPlan> plans{plan(test::icosphere(3), 0.3), plan(test::icosphere(3), 0.2)};
  const double wanted = plans[0].quads + plans[1].quads;
  CountBudget budget(plans, wanted);
  EXPECT_DOUBLE_EQ(budget.factor(), 1);
  budget.spend(plans[0].quads, 1.4 * plans[0].quads);
  ComponentPlan last = plans[1];
  scale_plan(last, budget.factor());
  EXPECT_NEAR(1.4 * plans[0].quads + last.quads, wanted, 1e-9 * wanted);
  EXPECT_NEAR(quads_for_lengths(last.mesh, last.target), last.quads, 1e-6 * last.quads);
  // But not all of it.
  budget.spend(0, 10 * wanted);
  EXPECT_GT(budget.factor(), 0.3);
}

std::vector<ComponentPlan> plans_of(const std::vector<double>& quads) {
  std::vector<ComponentPlan> plans(quads.size());
  for (std::size_t i = 0; i < quads.size(); ++i) plans[i].quads = quads[i];
  return plans;
}

TEST(ComponentWaves, EveryPartOnceTheSmallestFirstAndNoMoreThanHalfOfWhatIsLeft) {
  const std::vector<std::vector<double>> cases{{}, {7}, {3, 3}, {5, 1, 4, 2, 3}, {1000, 1, 1, 1, 1}, std::vector<double>(200, 5.0)};
  for (const std::vector<double>& quads : cases) {
    double left = std::accumulate(quads.begin(), quads.end(), 0.0), last = 0;
    std::vector<int> seen;
    for (const std::vector<int>& wave : component_waves(plans_of(quads))) {
      ASSERT_FALSE(wave.empty());
      double sum = 0;
      for (const int i : wave) {
        EXPECT_GE(quads[i], last);
        last = quads[i];
        sum += quads[i];
        seen.push_back(i);
      }
      EXPECT_TRUE(wave.size() == 1 || sum <= 0.5 * left + 1e-9);
      left -= sum;
    }
    std::sort(seen.begin(), seen.end());
    std::vector<int> all(quads.size());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(seen, all);
  }
}

TEST(ComponentWaves, ManyPartsTakeFewWavesAndTheLargestComesLast) {
  EXPECT_LE(component_waves(plans_of(std::vector<double>(200, 5.0))).size(), 9u);
  const std::vector<std::vector<int>> waves = component_waves(plans_of({40, 1000, 2, 3, 30}));
  EXPECT_EQ(waves.front(), (std::vector<int>{2, 3, 4, 0}));
  EXPECT_EQ(waves.back(), (std::vector<int>{1}));
}

}  // namespace
}  // namespace hybrid_quad
