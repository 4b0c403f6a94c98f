#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_quad/mesh/quad_complex.h"
#include "hybrid_quad/singular_patches/disk_fill.h"
#include "hybrid_quad/singular_patches/patch_quads.h"
#include "support/meshes.h"
#include "support/patches.h"

namespace hybrid_quad {
namespace {

using namespace test;

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (std::size_t i = 0; i < lines.size() && i < 8; ++i) all += lines[i] + "; ";
  return all;
}

TEST(CombinatorialFill, NeverFails) {
  for (int seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const TriangleMesh mesh = random_surface(seed % kSurfaceFamilies, random);
    PatchSurface patch = random_patch(mesh, Values::kRandom, random);
    for (const double factor : {0.02, 1.0, 100.0}) {
      patch.target_length = factor * 4 * mesh.mean_edge_length();
      const PatchQuads quads = combinatorial_fill(patch, RunContext{});
      QuadComplex complex;
      complex.positions = quads.positions;
      complex.opposite = quads.opposite;
      for (const auto& q : quads.quads) complex.vertex.insert(complex.vertex.end(), q.begin(), q.end());
      complex.curve.assign(quads.opposite.size(), -1);
      complex.kind.assign(quads.positions.size(), VertexKind::kFree);
      complex.anchor.assign(quads.positions.size(), 0);
      complex.near_face.assign(quads.positions.size(), -1);
      EXPECT_TRUE(violations_of(to_quad_mesh(complex)).empty()) << joined(violations_of(to_quad_mesh(complex)));
      const auto found = violations_of(quads, patch);
      EXPECT_TRUE(found.empty()) << "seed " << seed << " family " << seed % kSurfaceFamilies << " factor "
                                 << factor << ": " << joined(found);
    }
  }
}

TEST(CombinatorialFill, KeepsTheSizeOfQuadsWithinBounds) {
  for (const int family : {0, 2, 3, 5, 7, 8}) {
    std::mt19937 random(family);
    const TriangleMesh mesh = random_surface(family, random);
    PatchSurface patch = random_patch(mesh, Values::kRandom, random);
    patch.target_length = 3 * mesh.mean_edge_length();
    const PatchQuads quads = combinatorial_fill(patch, RunContext{});
    const double wanted = mesh.total_area() / (patch.target_length * patch.target_length);
    int border = 0;
    for (const int o : quads.opposite) border += o < 0;
    EXPECT_LT(quads.quads.size(), 8 * wanted + 8 * border + 150) << family;
    EXPECT_GT(quads.quads.size(), 0.2 * wanted) << family;
  }
}

TEST(CombinatorialFill, RefusesAPatchWithoutItsPrecondition) {
  std::mt19937 random(1);
  const PatchSurface good = random_patch(flat_grid(6, 6), Values::kRandom, random);
  PatchSurface odd = good;
  for (int& n : odd.node)
    if (n >= 0) {
      n = -1;
      break;
    }
  EXPECT_THROW(combinatorial_fill(odd, RunContext{}), InternalError);
  PatchSurface none = good;
  none.node.assign(none.node.size(), -1);
  EXPECT_THROW(combinatorial_fill(none, RunContext{}), InternalError);
}

BorderPolygon rectangle(int n, int m) {
  BorderPolygon p;
  p.target_length = 1;
  for (int i = 0; i < n; ++i) p.positions.push_back(Vector3(i, 0, 0));
  for (int i = 0; i < m; ++i) p.positions.push_back(Vector3(n, i, 0));
  for (int i = 0; i < n; ++i) p.positions.push_back(Vector3(n - i, m, 0));
  for (int i = 0; i < m; ++i) p.positions.push_back(Vector3(0, m - i, 0));
  p.normals.assign(p.positions.size(), Vector3(0, 0, 1));
  return p;
}

TEST(DiskFill, RectanglesBecomeTheirGrids) {
  for (const auto& [n, m] : {std::pair{1, 1}, {2, 1}, {3, 1}, {2, 2}, {5, 1}, {7, 1}}) {
    const DiskFill fill = fill_disk(rectangle(n, m));
    EXPECT_NEAR(fill.cost, 0, 1e-9) << n << " x " << m;
    EXPECT_EQ(fill.quads.size(), static_cast<std::size_t>(n * m));
  }
}

TEST(DiskFill, AnyPolygonIsADisk) {
  for (int seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    const int corners = 4 + 2 * static_cast<int>(random() % 7);
    BorderPolygon p;
    p.target_length = 1;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * M_PI * i / corners, radius = 1 + (random() % 1000) / 500.0;
      p.positions.push_back(Vector3(radius * std::cos(angle), radius * std::sin(angle), 0));
    }
    p.normals.assign(corners, Vector3(0, 0, 1));
    const DiskFill fill = fill_disk(p);
    const QuadComplex c = complex_of_quads(fill.positions, fill.quads);
    EXPECT_TRUE(violations_of(c).empty());
    EXPECT_EQ(euler_characteristic(c), 1);
    int border = 0;
    for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d)
      if (c.opposite[d] < 0) {
        ++border;
        EXPECT_EQ(c.to(d), (c.from(d) + 1) % corners);
      }
    EXPECT_EQ(border, corners);
  }
}

TEST(PatchQuads, EveryBrokenPromiseIsSeen) {
  std::mt19937 random(7);
  PatchSurface patch = random_patch(punctured(flat_grid(12, 12), 2, random), Values::kRandom, random);
  const PatchQuads good = combinatorial_fill(patch, RunContext{});
  ASSERT_TRUE(violations_of(good, patch).empty());
  const auto broken = [&](auto&& damage) {
    PatchQuads q = good;
    damage(q);
    return !violations_of(q, patch).empty();
  };
  int border = -1;
  for (int d = 0; d < static_cast<int>(good.opposite.size()); ++d)
    if (good.opposite[d] < 0) border = d;
  EXPECT_TRUE(broken([&](PatchQuads& q) { q.arc[border] = -1; }));
  EXPECT_TRUE(broken([&](PatchQuads& q) { q.arc[border] += 1; }));
  EXPECT_TRUE(broken([&](PatchQuads& q) { q.node[q.quads[border / 4][border % 4]] = -1; }));
  EXPECT_TRUE(broken([&](PatchQuads& q) { q.node[q.quads[border / 4][border % 4]] += 1000; }));
  EXPECT_TRUE(broken([&](PatchQuads& q) { std::swap(q.opposite[0], q.opposite[1]); }));
  EXPECT_TRUE(broken([&](PatchQuads& q) { q.opposite.clear(); }));
  EXPECT_TRUE(broken([&](PatchQuads& q) { q = PatchQuads{}; }));
  const PatchQuads other =
      combinatorial_fill(random_patch(flat_grid(12, 12), Values::kRandom, random), RunContext{});
  EXPECT_FALSE(violations_of(other, patch).empty());
}

}  // namespace
}  // namespace hybrid_quad
