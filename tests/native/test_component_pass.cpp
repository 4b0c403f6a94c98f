#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "hybrid_quad/mesh/topology.h"
#include "hybrid_quad/pipeline/component_pass.h"
#include "hybrid_quad/pipeline/stage_clock.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

TEST(ComponentPass, GoesOnFromItsSketch) {
  for (const TriangleMesh& mesh : {test::box(8, Vector3(1, 1, 1)), test::torus(40, 20)}) {
    const double length = std::sqrt(mesh.total_area() / 300);
    const ComponentPlan plan = plan_component(mesh, length, {}, {}, Wishes{}, RemeshOptions{}, RunContext{});
    const SurfaceIndex whole(mesh, {}, RunContext{});
    const Wishes wishes;
    const HardGuides guides;
    const RemeshOptions options;
    StageClock clock;
    ComponentPass pass(plan, whole, wishes, guides, options, PassSettings{});
    const QuadMesh sketch = pass.sketch(clock, RunContext{});
    EXPECT_EQ(violations_of(sketch), std::vector<std::string>{});
    EXPECT_EQ(topology_of(sketch), topology_of(mesh));
    const ComponentResult completed = pass.complete(clock, RunContext{});
    const ComponentResult at_once = run_pass(plan, whole, wishes, guides, options, PassSettings{}, clock, RunContext{});
    EXPECT_EQ(completed.mesh.quads, at_once.mesh.quads);
    EXPECT_EQ(completed.mesh.positions, at_once.mesh.positions);
    EXPECT_EQ(completed.work, at_once.work) << "what the sketch took is counted, once";
    EXPECT_EQ(completed.extracted_quads, at_once.extracted_quads);
    EXPECT_EQ(completed.field_singularities, at_once.field_singularities);
  }
}

}  // namespace
}  // namespace hybrid_quad
