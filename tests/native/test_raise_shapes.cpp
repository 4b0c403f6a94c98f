#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "hybrid_quad/improve/flaw_memory.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/quality/quality.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

constexpr int kSide = 12;

int id(int i, int j) { return (kSide + 1) * j + i; }

/// A flat square with even quads.
struct Square {
  Square() : input(test::flat_grid(kSide, kSide, kSide, kSide)), features(detect_features(input, FeatureOptions{}, RunContext{})), index(input, features.face_region) {
    for (int j = 0; j <= kSide; ++j)
      for (int i = 0; i <= kSide; ++i) {
        quads.positions.emplace_back(i, j, 0);
        quads.kind.push_back(VertexKind::kFree);
        quads.anchor.push_back(features.face_region[0]);
        quads.near_face.push_back(-1);
      }
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) quads.quads.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
  }
  int raise() { return raise_shapes(quads, input, features, index, ImproveOptions{}, Agreement{}, RunContext{}); }

  TriangleMesh input;
  FeatureGraph features;
  SurfaceIndex index;
  QuadMesh quads;
};

TEST(RaiseShapes, AConcaveQuadGetsAGoodShapeAndWhatIsFarStays) {
  Square square;
  square.quads.positions[id(6, 6)] = {6.7, 6.7, 0};
  const QuadMesh before = square.quads;
  ASSERT_LT(shape_quality(before).scaled_jacobian_min, 0);
  ASSERT_TRUE(flawed_quads(before, square.index, {}).empty());
  EXPECT_GT(square.raise(), 0);
  EXPECT_GT(shape_quality(square.quads).scaled_jacobian_min, 0.2);
  EXPECT_EQ(square.quads.quads, before.quads);
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) {
      EXPECT_EQ(square.quads.positions[id(i, j)].z(), 0);
      if (std::max(std::abs(i - 6), std::abs(j - 6)) > 4) { EXPECT_EQ(square.quads.positions[id(i, j)], before.positions[id(i, j)]); }
    }
}

TEST(RaiseShapes, GoodShapesStay) {
  Square square;
  square.quads.positions[id(6, 6)] = {6.2, 6.2, 0};
  const std::vector<Vector3> before = square.quads.positions;
  EXPECT_EQ(square.raise(), 0);
  EXPECT_EQ(square.quads.positions, before);
}

TEST(RaiseShapes, NoQuadIsTurnedOverForShape) {
  Square square;
  std::swap(square.quads.positions[id(5, 5)], square.quads.positions[id(6, 5)]);
  const std::size_t flawed = flawed_quads(square.quads, square.index, {}).size();
  const double worst = shape_quality(square.quads).scaled_jacobian_min;
  square.raise();
  EXPECT_LE(flawed_quads(square.quads, square.index, {}).size(), flawed);
  EXPECT_GE(shape_quality(square.quads).scaled_jacobian_min, worst);
}

/// A square of which all corners are given: one inside, beyond the diagonal between its neighbours.
struct Wedge {
  Wedge() : input(test::flat_grid(kSide, kSide, kSide, kSide)) {
    FeatureOptions options;
    options.corners = {id(0, 0), id(kSide, 0), id(kSide, kSide), id(0, kSide)};
    for (int k = 8; k < kSide; ++k) options.marked_edges.push_back({id(k, k), id(k + 1, k + 1)});
    features = detect_features(input, options, RunContext{});
    index = std::make_unique<SurfaceIndex>(input, features.face_region);
    for (const int v : {id(0, 0), id(kSide, 0), id(kSide, kSide), id(0, kSide), id(8, 8)}) {
      quads.positions.push_back(input.position(v));
      quads.kind.push_back(VertexKind::kCorner);
      quads.anchor.push_back(v);
      quads.near_face.push_back(-1);
    }
    // Halves of the boundary's sides, so that three quads meet at the inner corner.
    for (const int v : {id(kSide, 6), id(6, kSide)}) {
      quads.positions.push_back(input.position(v));
      quads.kind.push_back(VertexKind::kCurve);
      quads.anchor.push_back(-1);
      quads.near_face.push_back(-1);
    }
    quads.quads = {{0, 1, 4, 3}, {1, 5, 2, 4}, {4, 2, 6, 3}};
    for (int c = 0; c < static_cast<int>(features.curves.size()); ++c) {
      const std::vector<int>& along = features.curves[c].vertices;
      const auto vertex = [&](int v) {
        return static_cast<int>(std::find(quads.anchor.begin(), quads.anchor.end(), v) - quads.anchor.begin());
      };
      const int from = vertex(along.front()), to = vertex(along.back());
      int middle = -1;
      for (const int v : {5, 6})
        for (const int on : along)
          if (input.position(on) == quads.positions[v]) middle = v;
      if (middle < 0) {
        quads.feature_edges.push_back({from, to, c});
        continue;
      }
      quads.anchor[middle] = c;
      quads.feature_edges.push_back({from, middle, c});
      quads.feature_edges.push_back({middle, to, c});
    }
  }

  TriangleMesh input;
  FeatureGraph features;
  std::unique_ptr<SurfaceIndex> index;
  QuadMesh quads;
};

bool any_folded(const QuadMesh& mesh) {
  const auto& p = mesh.positions;
  return std::any_of(mesh.quads.begin(), mesh.quads.end(), [&](const auto& v) { return is_folded({p[v[0]], p[v[1]], p[v[2]], p[v[3]]}); });
}

TEST(SplitFolded, AConcaveQuadBetweenCornersIsSplit) {
  Wedge wedge;
  ASSERT_TRUE(violations_of(wedge.quads).empty());
  ASSERT_TRUE(any_folded(wedge.quads));
  const auto call = [&](auto function) {
    return function(wedge.quads, wedge.input, wedge.features, *wedge.index, ImproveOptions{}, Agreement{}, RunContext{}, nullptr);
  };
  EXPECT_EQ(call(raise_shapes), 0);  // nothing there may move far enough
  EXPECT_GT(call(split_folded_quads), 0);
  EXPECT_FALSE(any_folded(wedge.quads));
  EXPECT_TRUE(violations_of(wedge.quads).empty());
  EXPECT_TRUE(flawed_quads(wedge.quads, *wedge.index, {}).empty());
}

TEST(Workpiece, VerticesOnACurveKeepApart) {
  Wedge wedge;
  Workpiece piece(wedge.quads, wedge.input, wedge.features, *wedge.index);
  piece.locate_all();
  constexpr int kMiddle = 5;
  for (const int direction : {1, -1}) {
    const double gap = piece.gap(kMiddle, direction);
    EXPECT_DOUBLE_EQ(gap, 6);
    EXPECT_DOUBLE_EQ(piece.room(kMiddle, direction, 1), 0.8 * gap);
    EXPECT_DOUBLE_EQ(piece.room(kMiddle, direction, 30), gap - 3);
    EXPECT_DOUBLE_EQ(piece.room(kMiddle, direction, 100), 0);
  }
}

}  // namespace
}  // namespace hybrid_quad
