// What happens where a stage breaks its promise, and that patches alone are enough.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "hybrid_quad/assemble/assemble.h"
#include "hybrid_quad/mesh/topology.h"
#include "hybrid_quad/pipeline/attempts.h"
#include "hybrid_quad/regular_quads/regular_quads.h"
#include "hybrid_quad/singular_patches/singular_patches.h"
#include "hybrid_quad/sizing/sizing.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

TEST(Attempts, TheNextOneFollowsABrokenPromiseAndIsCounted) {
  for (int broken = 0; broken <= 2; ++broken) {
    RepairRecord repairs;
    std::vector<std::string> warnings;
    std::vector<Attempt> tried;
    const Attempt kept = extract_by_any_means(
        [&](Attempt attempt) {
          tried.push_back(attempt);
          if (static_cast<int>(tried.size()) <= broken) throw InternalError("assemble", "a grid edge has no end");
          return attempt;
        },
        repairs, warnings);
    EXPECT_EQ(kept, (std::array{Attempt::kFull, Attempt::kWithoutCancellation, Attempt::kPatchesOnly})[broken]);
    EXPECT_EQ(static_cast<int>(tried.size()), broken + 1);
    EXPECT_EQ(repairs.broken_promises, broken);
    ASSERT_EQ(static_cast<int>(warnings.size()), broken);
    for (const std::string& warning : warnings) EXPECT_NE(warning.find("a grid edge has no end"), std::string::npos);
  }
}

TEST(Attempts, TheLastOneSaysWhatBroke) {
  RepairRecord repairs;
  std::vector<std::string> warnings;
  const auto breaks = [](Attempt attempt) -> int { throw InternalError("assemble", std::to_string(static_cast<int>(attempt))); };
  try {
    extract_by_any_means(breaks, repairs, warnings);
    FAIL() << "nothing was extracted";
  } catch (const InternalError& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(static_cast<int>(Attempt::kPatchesOnly))), std::string::npos);
  }
  EXPECT_EQ(repairs.broken_promises, 2);
}

TEST(Attempts, WhatBrokeIsToldWhicheverResultIsKept) {
  ComponentResult dropped, kept;
  record_broken_promise(InternalError("assemble", "one"), dropped.repairs, dropped.warnings);
  record_broken_promise(InternalError("improve", "two"), kept.repairs, kept.warnings);
  keep_broken_promises(dropped, kept);
  EXPECT_EQ(kept.repairs.broken_promises, 2);
  EXPECT_EQ(kept.warnings.size(), 2u);
}

/// From the field to the assembled quads, with nothing regular.
QuadComplex quads_of_patches(const WorkingSurface& surface, const FrameField& frames) {
  const PeriodicField psi = solve_periodic_field(surface, frames, PeriodicFieldOptions{}, RunContext{});
  SpanningParameterization param = build_spanning_parameterization(surface, frames, psi, SpanningOptions{}, RunContext{});
  std::fill(param.is_regular.begin(), param.is_regular.end(), 0);
  RegularQuads regular = extract_regular_quads(surface, frames, param, RunContext{});
  EXPECT_TRUE(violations_of(regular).empty());
  EXPECT_TRUE(regular.side.empty());
  const SingularPatches patches = fill_singular_patches(surface, frames, param, regular, PatchOptions{}, RunContext{});
  EXPECT_NEAR(patches.singular_area, surface.mesh.total_area(), 1e-6 * surface.mesh.total_area());
  return assemble_quads(surface, regular, patches);
}

TEST(Attempts, PatchesAloneMakeTheSurface) {
  const struct {
    TriangleMesh mesh;
    double length;
  } cases[] = {{test::flat_grid(12, 9, 4, 3), 0.5},  {test::box(6), 0.3},       {test::icosphere(3), 0.4},
               {test::torus(24, 12), 0.4},           {test::open_cylinder(20, 10), 0.5}, {test::capped_cylinder(20, 10), 0.4}};
  for (const auto& each : cases) {
    const WorkingSurface surface = test::surface_of(each.mesh, each.length);
    QuadComplex complex = quads_of_patches(surface, test::smooth_frames(surface, each.length));
    const Topology topology = topology_of(surface.mesh);
    EXPECT_TRUE(violations_of(complex).empty());
    EXPECT_EQ(topology_of(complex), topology);
    repair_complex(complex);
    const QuadMesh mesh = to_quad_mesh(complex);
    EXPECT_TRUE(violations_of(mesh).empty());
    EXPECT_EQ(topology_of(mesh), topology);
  }
}

/// A function that oscillates has far more extrema than the asked lengths have room for.
TEST(Attempts, APatchWithMoreQuadsThanRoomIsFilledAndCounted) {
  WorkingSurface surface = test::surface_of(test::flat_grid(24, 18, 12, 9), 1);
  const FrameField frames = test::constant_frames(surface, Vector3(1, 0, 0), Vector3(0, 1, 0));
  const PeriodicField psi = solve_periodic_field(surface, frames, PeriodicFieldOptions{}, RunContext{});
  SpanningParameterization param = build_spanning_parameterization(surface, frames, psi, SpanningOptions{}, RunContext{});
  std::fill(param.is_regular.begin(), param.is_regular.end(), 0);
  for (const double longer : {1.0, 4.0}) {
    for (double& length : surface.target_length) length *= longer;
    RegularQuads regular = extract_regular_quads(surface, frames, param, RunContext{});
    const SingularPatches patches = fill_singular_patches(surface, frames, param, regular, PatchOptions{}, RunContext{});
    ASSERT_EQ(patches.patches.size(), 1u);
    const FilledPatch& patch = patches.patches.front();
    EXPECT_EQ(patch.combinatorial, longer > 1);
    EXPECT_EQ(patch.rejected.empty(), longer == 1);
    EXPECT_NEAR(patch.area, 108, 1e-9);
    const QuadComplex complex = assemble_quads(surface, regular, patches);
    EXPECT_TRUE(violations_of(complex).empty());
    EXPECT_EQ(topology_of(complex), topology_of(surface.mesh));
    EXPECT_EQ(complex.quad_count() < 108, longer > 1);
  }
}

}  // namespace
}  // namespace hybrid_quad
