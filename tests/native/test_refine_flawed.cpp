#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <set>
#include <utility>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/local_refinement.h"
#include "hybrid_quad/mesh/quad_complex.h"
#include "hybrid_quad/quality/quality.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

constexpr int kSize = 20, kCells = 5, kStep = 4;

int id(int x, int y) { return (kSize + 1) * y + x; }
int at(int i, int j) { return (kCells + 1) * j + i; }

/// A sheet of 5 x 5 quads whose inner vertices can't move and are off their places, at random by up to `most` in x and y: sides
/// have to go around vertices in their way.
struct Sheet {
  Sheet(unsigned seed, int most) : input(test::flat_grid(kSize, kSize, kSize, kSize)) {
    FeatureOptions options;
    options.corners = {id(0, 0), id(kSize, 0), id(kSize, kSize), id(0, kSize)};
    features = detect_features(input, options, RunContext{});
    index = std::make_unique<SurfaceIndex>(input, features.face_region);
    std::mt19937 random(seed);
    std::set<int> taken;
    for (int j = 0; j <= kCells; ++j)
      for (int i = 0; i <= kCells; ++i) {
        const bool on_x = i == 0 || i == kCells, on_y = j == 0 || j == kCells;
        const auto off = [&](int k) {
          const int by = static_cast<int>(random() % (2 * most + 1)) - most;
          return std::clamp(kStep * k + by, 1, kSize - 1);
        };
        int v = id(kStep * i, kStep * j);
        if (!on_x && !on_y) do {
            const int x = off(i), y = off(j);
            v = id(x, y);
          } while (taken.count(v) > 0);
        taken.insert(v);
        const bool on_curve = on_x != on_y;
        quads.positions.push_back(input.position(v));
        quads.kind.push_back(on_curve ? VertexKind::kCurve : VertexKind::kCorner);
        quads.anchor.push_back(on_curve ? curve_at(input.position(v)) : v);
        quads.near_face.push_back(-1);
      }
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) quads.quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    for (int k = 0; k < kCells; ++k) {
      add_feature_edge(at(k, 0), at(k + 1, 0));
      add_feature_edge(at(k, kCells), at(k + 1, kCells));
      add_feature_edge(at(0, k), at(0, k + 1));
      add_feature_edge(at(kCells, k), at(kCells, k + 1));
    }
  }

  int curve_at(const Vector3& p) const {
    for (int c = 0; c < static_cast<int>(features.curves.size()); ++c)
      for (const int v : features.curves[c].vertices)
        if (input.position(v) == p) return c;
    return -1;
  }

  void add_feature_edge(int a, int b) {
    const int curve = curve_at(0.5 * (quads.positions[a] + quads.positions[b]));
    const std::vector<int>& along = features.curves[curve].vertices;
    const Vector3 direction = input.position(along.back()) - input.position(along.front());
    if (direction.dot(quads.positions[b] - quads.positions[a]) < 0) std::swap(a, b);
    quads.feature_edges.push_back({a, b, curve});
  }

  int split() { return split_flawed_quads(quads, input, features, *index, ImproveOptions{}, Agreement{}, RunContext{}); }
  int refine() { return refine_flawed_quads(quads, input, features, *index, ImproveOptions{}, Agreement{}, RunContext{}); }
  std::size_t flawed() const { return flawed_quads(quads, *index, {}).size(); }

  TriangleMesh input;
  FeatureGraph features;
  std::unique_ptr<SurfaceIndex> index;
  QuadMesh quads;
};

/// Each vertex on the boundary is on its curve, and the feature edges are the sides on the boundary.
void expect_boundary_on_curves(const Sheet& sheet) {
  const QuadMesh& mesh = sheet.quads;
  std::set<std::pair<int, int>> open;
  for (const auto& q : mesh.quads)
    for (int i = 0; i < 4; ++i) {
      const std::pair<int, int> side{std::min(q[i], q[(i + 1) & 3]), std::max(q[i], q[(i + 1) & 3])};
      if (!open.insert(side).second) open.erase(side);
    }
  EXPECT_EQ(open.size(), mesh.feature_edges.size());
  for (const QuadMesh::FeatureEdge& e : mesh.feature_edges) {
    EXPECT_EQ(open.count({std::min(e.a, e.b), std::max(e.a, e.b)}), 1u);
    const std::vector<int>& along = sheet.features.curves[e.curve].vertices;
    const Vector3 from = sheet.input.position(along.front()), way = (sheet.input.position(along.back()) - from).normalized();
    for (const int v : {e.a, e.b}) EXPECT_LT((mesh.positions[v] - from).cross(way).norm(), 1e-12);
    EXPECT_GT(way.dot(mesh.positions[e.b] - mesh.positions[e.a]), 0);
  }
}

struct Case {
  unsigned seed;
  int most;
};

class RefineFlawed : public testing::TestWithParam<Case> {};

TEST_P(RefineFlawed, WhatNoSplitPutsRightIsPutRight) {
  Sheet sheet(GetParam().seed, GetParam().most);
  const QuadMesh before = sheet.quads;
  sheet.split();
  ASSERT_GT(sheet.flawed(), 0u);
  EXPECT_GT(sheet.refine(), 0);
  EXPECT_EQ(sheet.flawed(), 0u);
  EXPECT_TRUE(violations_of(sheet.quads).empty());
  EXPECT_EQ(euler_characteristic(sheet.quads), 1);
  for (std::size_t v = 0; v < before.positions.size(); ++v)
    if (before.kind[v] == VertexKind::kCorner) {
      EXPECT_EQ(sheet.quads.positions[v], before.positions[v]);
    }
  expect_boundary_on_curves(sheet);
}

INSTANTIATE_TEST_SUITE_P(Sheets, RefineFlawed, testing::Values(Case{4, 3}, Case{6, 5}));

TEST(RefineFlawed, NothingWhereNothingIsFlawed) {
  Sheet sheet(0, 0);
  const QuadMesh before = sheet.quads;
  EXPECT_EQ(sheet.refine(), 0);
  EXPECT_EQ(sheet.quads.quads, before.quads);
  EXPECT_EQ(sheet.quads.positions, before.positions);
}

/// Whatever quads are chosen: all ways that the sides of a quad can be split come up.
TEST(LocalRefinement, AnyQuadsCanBeRefined) {
  std::mt19937 random(0);
  for (int trial = 0; trial < 40; ++trial) {
    Sheet sheet(0, 0);
    const QuadMesh before = sheet.quads;
    std::vector<char> chosen;
    for (std::size_t q = 0; q < before.quads.size(); ++q) chosen.push_back(random() % 4 != 0);
    Workpiece piece(before, sheet.input, sheet.features, *sheet.index);
    piece.locate_all();
    std::vector<int> touched;
    sheet.quads = refine_locally(before, piece, chosen, &touched);
    EXPECT_TRUE(violations_of(sheet.quads).empty());
    EXPECT_EQ(euler_characteristic(sheet.quads), 1);
    EXPECT_EQ(sheet.flawed(), 0u);
    EXPECT_GT(shape_quality(sheet.quads).scaled_jacobian_min, -1e-12);  // corners of half a turn come up
    expect_boundary_on_curves(sheet);
    for (std::size_t v = 0; v < before.positions.size(); ++v) EXPECT_EQ(sheet.quads.positions[v], before.positions[v]);
    for (std::size_t q = 0; q < before.quads.size(); ++q)
      if (!chosen[q]) {
        EXPECT_EQ(sheet.quads.quads[q], before.quads[q]);
      }
  }
}

TEST(LocalRefinement, NineQuadsForOneWhereAllAreChosen) {
  Sheet sheet(0, 0);
  Workpiece piece(sheet.quads, sheet.input, sheet.features, *sheet.index);
  piece.locate_all();
  std::vector<int> touched;
  const QuadMesh refined = refine_locally(sheet.quads, piece, std::vector<char>(kCells * kCells, 1), &touched);
  EXPECT_EQ(refined.quads.size(), 9u * kCells * kCells);
  EXPECT_EQ(touched.size(), refined.positions.size());
}

TEST(LocalRefinement, CurvesWithAnAskedNumberOfEdgesKeepIt) {
  Sheet sheet(0, 0);
  for (FeatureCurve& curve : sheet.features.curves) curve.asked_count = kCells;
  Workpiece piece(sheet.quads, sheet.input, sheet.features, *sheet.index);
  piece.locate_all();
  std::vector<int> touched;
  const QuadMesh refined = refine_locally(sheet.quads, piece, std::vector<char>(kCells * kCells, 1), &touched);
  EXPECT_EQ(refined.feature_edges.size(), sheet.quads.feature_edges.size());
  EXPECT_GT(refined.quads.size(), sheet.quads.quads.size());
  EXPECT_TRUE(violations_of(refined).empty());
}

}  // namespace
}  // namespace hybrid_quad
