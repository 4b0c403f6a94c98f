#include <gtest/gtest.h>

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
  balance_plans(plans, asked);
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
  balance_plans(plans, asked);
  EXPECT_LE(plans[0].quads, 1.02 * asked);
  std::vector<ComponentPlan> hopeless{alone};
  balance_plans(hopeless, 1);
  for (int v = 0; v < alone.mesh.vertex_count(); ++v) EXPECT_LE(hopeless[0].target[v], 2 * alone.length + 1e-12);
  EXPECT_GT(hopeless[0].quads, alone.quads / 4.1);
}

TEST(SizePlan, LeavesRoomySurfacesAlone) {
  std::vector<ComponentPlan> plans{plan(test::icosphere(4), 0.2)};
  const std::vector<double> before = plans[0].target;
  balance_plans(plans, test::icosphere(4).total_area() / 0.04);
  EXPECT_EQ(plans[0].target, before);
}

TEST(SizePlan, RefinesWhereTold) {
  const ComponentPlan coarse = plan(test::icosphere(4), 0.3);
  const Vector3 pole(0, 0, 1);
  const ComponentPlan fine = refined_plan(coarse, 1.0, false, {{pole, 0.1}});
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
  EXPECT_NEAR(refined_plan(coarse, 2.0, false, {}).quads, 2 * coarse.quads, 1e-6 * coarse.quads);
}

}  // namespace
}  // namespace hybrid_quad
