#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "hybrid_quad/pipeline/finishing.h"
#include "hybrid_quad/mesh/topology.h"
#include "hybrid_quad/pipeline/split_triangles.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

ComponentPlan plan_of(const TriangleMesh& mesh, double length) {
  return plan_component(mesh, length, {}, {}, Wishes{}, RemeshOptions{}, RunContext{});
}

/// A component's result with so many quads, one of which counts as flawed.
ComponentResult flawed_result(std::size_t quads) {
  ComponentResult result;
  result.mesh.quads.assign(quads, {0, 1, 2, 3});
  result.flawed_quads = 1;
  result.area = 6;
  result.rings = {{0, 1, 0}};
  return result;
}

TEST(SplitTriangles, AreQuadsInTheSurfaceOnTheCurvesOfThePlan) {
  const TriangleMesh surfaces[] = {test::box(2), test::icosphere(1), test::torus(8, 5), test::open_cylinder(6, 1, 1, 5), test::flat_grid(2, 3)};
  for (const TriangleMesh& surface : surfaces) {
    const ComponentPlan plan = plan_of(surface, 0.1);
    ASSERT_GT(plan.mesh.face_count(), surface.face_count()) << "long edges are halved";
    const std::optional<QuadMesh> quads = split_triangles(surface, plan);
    ASSERT_TRUE(quads);
    EXPECT_EQ(quads->quads.size(), static_cast<std::size_t>(3 * surface.face_count()));
    EXPECT_EQ(violations_of(*quads), std::vector<std::string>{});
    EXPECT_EQ(topology_of(*quads), topology_of(surface));
    EXPECT_TRUE(flawed_quads(*quads, *plan.index, least_agreement(*plan.index)).empty());
    double on_curves = 0, curves = 0;
    for (const QuadMesh::FeatureEdge& e : quads->feature_edges) {
      on_curves += (quads->positions[e.b] - quads->positions[e.a]).norm();
      for (const int v : {e.a, e.b}) EXPECT_NE(quads->kind[v], VertexKind::kFree);
    }
    for (const FeatureCurve& curve : plan.features.curves)
      for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
        curves += (plan.mesh.position(curve.vertices[i + 1]) - plan.mesh.position(curve.vertices[i])).norm();
    EXPECT_NEAR(on_curves, curves, 1e-9);
    for (std::size_t v = 0; v < quads->positions.size(); ++v)
      if (quads->kind[v] == VertexKind::kCorner) {
        EXPECT_TRUE(plan.features.is_corner[quads->anchor[v]]);
        EXPECT_EQ(quads->positions[v], plan.mesh.position(quads->anchor[v]));
      }
  }
}

TEST(SplitTriangles, TakeThePlaceOfFlawedQuadsWhereTheyAreFewEnough) {
  const TriangleMesh surface = test::box(2);
  const ComponentPlan plan = plan_of(surface, 0.2);
  const auto kept = [&](double wanted, ComponentResult result) {
    keep_triangles(surface, plan, wanted, *plan.index, 1, result);
    return result;
  };
  const ComponentResult taken = kept(80, flawed_result(10));
  EXPECT_EQ(taken.mesh.quads.size(), 144u);
  EXPECT_EQ(taken.flawed_quads, 0);
  EXPECT_EQ(taken.repairs.split_triangles, 48);
  EXPECT_EQ(taken.patches.combinatorial, 1);
  EXPECT_EQ(taken.combinatorial_area, taken.area);
  EXPECT_EQ(taken.warnings.size(), 1u);
  EXPECT_EQ(taken.features.curves.size(), 12u);
  EXPECT_TRUE(taken.rings.empty());
  EXPECT_EQ(kept(10, flawed_result(80)).mesh.quads.size(), 144u);
  EXPECT_EQ(kept(60, flawed_result(60)).mesh.quads.size(), 60u) << "more than twice as many";
  ComponentResult sound = flawed_result(100);
  sound.flawed_quads = 0;
  EXPECT_EQ(kept(100, sound).mesh.quads.size(), 100u);
}

}  // namespace
}  // namespace hybrid_quad
