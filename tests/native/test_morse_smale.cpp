#include <gtest/gtest.h>

#include <algorithm>

#include "hybrid_quad/singular_patches/discrete_gradient.h"
#include "hybrid_quad/singular_patches/morse_smale_gluing.h"
#include "hybrid_quad/singular_patches/node_chords.h"
#include "support/meshes.h"
#include "support/patches.h"

namespace hybrid_quad {
namespace {

using namespace test;

constexpr Values kAllValues[] = {Values::kRandom, Values::kConstant, Values::kWave, Values::kFew,
                                 Values::kWild};

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (std::size_t i = 0; i < lines.size() && i < 8; ++i) all += lines[i] + "; ";
  return all;
}

TEST(DiscreteGradient, CriticalCellsCountTheEulerCharacteristicAndPathsDescend) {
  for (int seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    const TriangleMesh mesh = random_surface(seed % kSurfaceFamilies, random);
    std::vector<int> rank(mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) rank[v] = v;
    std::shuffle(rank.begin(), rank.end(), random);
    const DiscreteGradient g = discrete_gradient(mesh, rank, std::vector<int>(mesh.vertex_count(), -1));
    const auto minima = std::count(g.down.begin(), g.down.end(), -1),
               maxima = std::count(g.up.begin(), g.up.end(), -1);
    EXPECT_EQ(minima - static_cast<long>(g.critical_edges.size()) + maxima, mesh.euler_characteristic());

    std::vector<int> uses(mesh.halfedge_count(), 0);  // every edge exactly once
    for (int v = 0; v < mesh.vertex_count(); ++v)
      if (g.down[v] >= 0) {
        const int w = mesh.from(g.down[v]) == v ? mesh.to(g.down[v]) : mesh.from(g.down[v]);
        EXPECT_LT(rank[w], rank[v]);
        ++uses[DiscreteGradient::edge_of(mesh, g.down[v])];
      }
    for (const int h : g.up)
      if (h >= 0) ++uses[DiscreteGradient::edge_of(mesh, h)];
    for (const int h : g.critical_edges) ++uses[h];
    for (int h = 0; h < mesh.halfedge_count(); ++h)
      EXPECT_EQ(uses[h], DiscreteGradient::edge_of(mesh, h) == h ? 1 : 0);
  }
}

TEST(MorseSmale, AnyFunctionOnAnySurfaceGivesAComplexWithThePatchsTopologyAndBorder) {
  int valid = 0, runs = 0;
  for (int seed = 0; seed < 600; ++seed) {
    std::mt19937 random(1000 + seed);
    const TriangleMesh mesh = random_surface(seed % kSurfaceFamilies, random);
    const PatchSurface patch = random_patch(mesh, kAllValues[(seed / kSurfaceFamilies) % 5], random);
    for (const double persistence : {0.0, 0.3, 1.0}) {
      const PatchQuads quads = morse_smale_quads(patch, persistence, RunContext{});
      const std::vector<std::string> found = violations_of(quads, patch);
      ++runs;
      valid += found.empty();
      if (quads.quads.empty()) {
        EXPECT_EQ(mesh.euler_characteristic(), 2);  // one minimum and one maximum: a sphere
        continue;
      }
      const std::vector<std::string> structural = structural_violations_of(quads, patch);
      EXPECT_TRUE(structural.empty()) << "seed " << seed << ": " << joined(structural);
    }
  }
  RecordProperty("valid", valid);
  RecordProperty("runs", runs);
  EXPECT_GT(valid, runs / 3);
}

TEST(MorseSmale, AWaveGivesItsGrid) {
  const int n = 6, cell = 8;
  const TriangleMesh mesh = flat_grid(n * cell, n * cell, n, n);
  PatchSurface patch;
  patch.mesh = mesh;
  patch.target_length = 1;
  patch.node.assign(mesh.vertex_count(), -1);
  patch.boundary_arc.assign(mesh.halfedge_count(), -1);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vector3& p = mesh.position(v);
    double value = std::cos(M_PI * p.x()) * std::cos(M_PI * p.y());
    if (mesh.is_boundary_vertex(v) && std::abs(std::abs(value) - 1) < 1e-9) {
      patch.node[v] = v;
      value *= 1.01;
    }
    patch.morse.push_back(value);
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h)) continue;
    const Vector3 middle = 0.5 * (mesh.position(mesh.from(h)) + mesh.position(mesh.to(h)));
    const int side = middle.y() == 0 ? 0 : middle.x() == n ? 1 : middle.y() == n ? 2 : 3;
    patch.boundary_arc[h] = side * n + static_cast<int>(side % 2 ? middle.y() : middle.x());
  }
  const PatchQuads quads = morse_smale_quads(patch, 0.3, RunContext{});
  EXPECT_TRUE(violations_of(quads, patch).empty()) << joined(violations_of(quads, patch));
  EXPECT_EQ(quads.quads.size(), static_cast<std::size_t>(n * n));
  for (const auto& q : quads.quads)
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR((quads.positions[q[i]] - quads.positions[q[(i + 1) & 3]]).norm(), 1, 1e-9);
}

TEST(MorseSmale, CancellationRemovesNoise) {
  const TriangleMesh mesh = icosphere(5);
  std::mt19937 random(5);
  PatchSurface patch = random_patch(mesh, Values::kConstant, random);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vector3& p = mesh.position(v);
    patch.morse[v] =
        std::cos(3 * M_PI * p.x()) * std::cos(3 * M_PI * p.y()) + 0.3 * (random() / 4294967296.0 - 0.5);
  }
  const std::size_t noisy = morse_smale_quads(patch, 0, RunContext{}).quads.size();
  const std::size_t clean = morse_smale_quads(patch, 0.3, RunContext{}).quads.size();
  EXPECT_LT(2 * clean, noisy);
  EXPECT_GT(clean, 20u);
}

TEST(MorseSmale, SameInputSameQuads) {
  std::mt19937 random(3);
  const PatchSurface patch = random_patch(punctured(torus(20, 12), 4, random), Values::kFew, random);
  const PatchQuads a = morse_smale_quads(patch, 0.3, RunContext{}),
                   b = morse_smale_quads(patch, 0.3, RunContext{});
  EXPECT_EQ(a.quads, b.quads);
  EXPECT_EQ(a.opposite, b.opposite);
}

}  // namespace
}  // namespace hybrid_quad
