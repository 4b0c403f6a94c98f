#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "hybrid_quad/improve/shape_descent.h"
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
  Square()
      : input(test::flat_grid(kSide, kSide, kSide, kSide)),
        features(detect_features(input, FeatureOptions{}, RunContext{})),
        index(input, features.face_region),
        quads(test::even_quads(kSide, features.face_region[0])) {}
  int raise() { return raise_shapes(quads, input, features, index, ImproveOptions{}, RunContext{}); }

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

TEST(RaiseShapes, WhatEndsASearchIsCounted) {
  Square square;
  square.quads.positions[id(6, 6)] = {6.7, 6.7, 0};
  square.quads.positions[id(2, 2)] = {2.7, 2.7, 0};
  using Counts = std::array<int, 2>;  // places raised, searches ended
  const auto raise = [&square](long long most) {
    ImproveOptions options;
    options.most_boxes_opened = most;
    Counts counts{0, 0};
    counts[0] =
        raise_shapes(square.quads, square.input, square.features, square.index, options, RunContext{}, nullptr, &counts[1]);
    return counts;
  };
  EXPECT_EQ(raise(0), (Counts{1, 1})) << "the first is looked at, the second is not";
  EXPECT_EQ(raise(ImproveOptions{}.most_boxes_opened), (Counts{1, 0}));
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

/// Four quads around a corner inside a square: where it is given, (c, c), one of them is a triangle (9) or concave (10).
struct Cross {
  Cross(VertexKind halfway, int c) : input(test::flat_grid(kSide, kSide, kSide, kSide)) {
    FeatureOptions options;
    options.corners = {id(0, 0), id(kSide, 0), id(kSide, kSide), id(0, kSide)};
    features = detect_features(input, options, RunContext{});
    index = std::make_unique<SurfaceIndex>(input, features.face_region);
    const std::array<int, 3> at{0, kSide / 2, kSide};
    for (const int y : at)
      for (const int x : at) {
        const bool is_halfway = (x == kSide / 2) != (y == kSide / 2), is_inside = x == kSide / 2 && y == kSide / 2;
        const int v = is_inside ? id(c, c) : id(x, y);
        quads.positions.push_back(input.position(v));
        quads.kind.push_back(is_halfway ? halfway : VertexKind::kCorner);
        quads.anchor.push_back(v);
        quads.near_face.push_back(-1);
      }
    quads.quads = {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}};
    for (int k = 0; k < static_cast<int>(features.curves.size()); ++k) {
      const std::vector<int>& along = features.curves[k].vertices;
      std::vector<int> chain;
      for (const int on : along)
        for (int v = 0; v < 9; ++v)
          if (quads.positions[v] == input.position(on)) chain.push_back(v);
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) quads.feature_edges.push_back({chain[i], chain[i + 1], k});
      if (halfway == VertexKind::kCurve) quads.anchor[chain[1]] = k;
    }
  }

  TriangleMesh input;
  FeatureGraph features;
  std::unique_ptr<SurfaceIndex> index;
  QuadMesh quads;
};

bool any_folded(const QuadMesh& mesh) {
  const auto& p = mesh.positions;
  return std::any_of(mesh.quads.begin(), mesh.quads.end(), [&](const auto& v) { return scaled_jacobian(p[v[0]], p[v[1]], p[v[2]], p[v[3]]) <= kFolded; });
}

TEST(SplitFolded, AQuadBetweenCornersThatIsATriangleIsSplit) {
  Cross cross(VertexKind::kCorner, 9);
  ASSERT_TRUE(violations_of(cross.quads).empty());
  ASSERT_TRUE(any_folded(cross.quads));
  ASSERT_TRUE(flawed_quads(cross.quads, *cross.index, {}).empty());
  const auto split = [&] {
    return split_folded_quads(cross.quads, cross.input, cross.features, *cross.index, ImproveOptions{}, RunContext{});
  };
  EXPECT_EQ(raise_shapes(cross.quads, cross.input, cross.features, *cross.index, ImproveOptions{}, RunContext{}), 0)
      << "all vertices are given";
  EXPECT_GT(split(), 0);
  EXPECT_FALSE(any_folded(cross.quads));
  EXPECT_TRUE(violations_of(cross.quads).empty());
  EXPECT_TRUE(flawed_quads(cross.quads, *cross.index, {}).empty());
  EXPECT_EQ(split(), 0);
}

TEST(SplitFolded, WhatIsFarStaysAndNothingIsSplitWhereNoQuadIsFolded) {
  Square square;
  const QuadMesh before = square.quads;
  const auto split = [&] {
    return split_folded_quads(square.quads, square.input, square.features, square.index, ImproveOptions{}, RunContext{});
  };
  EXPECT_EQ(split(), 0);
  EXPECT_EQ(square.quads.positions, before.positions);
  // A corner in a place where it makes a quad concave: no place helps.
  square.quads.positions[id(6, 6)] = {6.7, 6.7, 0};
  square.quads.kind[id(6, 6)] = VertexKind::kCorner;
  square.quads.anchor[id(6, 6)] = -1;
  for (const int v : {id(5, 5), id(6, 5), id(7, 5), id(7, 6), id(7, 7), id(6, 7), id(5, 7), id(5, 6)}) square.quads.kind[v] = VertexKind::kCorner;
  ASSERT_TRUE(any_folded(square.quads));
  EXPECT_GT(split(), 0);
  EXPECT_FALSE(any_folded(square.quads));
  EXPECT_TRUE(violations_of(square.quads).empty());
  EXPECT_TRUE(flawed_quads(square.quads, square.index, {}).empty());
  EXPECT_LE(square.quads.quads.size(), before.quads.size() + 8);
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i)
      if (std::max(std::abs(i - 6), std::abs(j - 6)) > 3) { EXPECT_EQ(square.quads.positions[id(i, j)], before.positions[id(i, j)]); }
}

/// A corner in a place where it makes a quad concave, with corners all around.
void fold_at(Square& square, int i, int j, const std::array<double, 2>& shift) {
  square.quads.positions[id(i, j)] = {i + shift[0], j + shift[1], 0};
  for (int y = j - 1; y <= j + 1; ++y)
    for (int x = i - 1; x <= i + 1; ++x) {
      square.quads.kind[id(x, y)] = VertexKind::kCorner;
      square.quads.anchor[id(x, y)] = -1;
    }
}

TEST(SplitFolded, TheLastSplitsAreSuchAsThereIsRoomFor) {
  // Some splits add two quads, others with better shapes more; there may be eight more in all.
  constexpr std::size_t kRoom = 8;
  const std::vector<std::vector<std::array<double, 2>>> shifts = {
      {{0.808, 0.540}, {0.795, 0.604}, {0.622, 0.757}, {0.839, 0.863}},
      {{0.841, 0.868}, {0.906, 0.681}, {0.612, 0.830}},
      {{0.442, 0.947}, {0.527, 0.835}, {0.796, 0.412}},
      {{0.509, 0.865}, {0.881, 0.497}, {0.724, 0.948}},
      {{0.461, 0.980}, {0.553, 0.878}, {0.971, 0.430}, {0.852, 0.649}}};
  for (const auto& places : shifts) {
    Square square;
    const std::size_t before = square.quads.quads.size();
    for (int k = 0; k < static_cast<int>(places.size()); ++k) fold_at(square, k % 2 ? 9 : 3, k / 2 ? 9 : 3, places[k]);
    ASSERT_TRUE(any_folded(square.quads));
    split_folded_quads(square.quads, square.input, square.features, square.index, ImproveOptions{}, RunContext{});
    EXPECT_FALSE(any_folded(square.quads));
    EXPECT_EQ(square.quads.quads.size(), before + kRoom);
    EXPECT_TRUE(violations_of(square.quads).empty());
  }
}

TEST(SplitFolded, NoQuadIsTurnedOver) {
  for (const int c : {8, 9, 10, 11}) {
    Cross cross(VertexKind::kCorner, c);
    const std::size_t flawed = flawed_quads(cross.quads, *cross.index, {}).size();
    split_folded_quads(cross.quads, cross.input, cross.features, *cross.index, ImproveOptions{}, RunContext{});
    EXPECT_LE(flawed_quads(cross.quads, *cross.index, {}).size(), flawed) << c;
    EXPECT_FALSE(any_folded(cross.quads)) << c;
  }
}

TEST(RaiseShapes, WhereItHasFailedNothingIsTriedAgain) {
  Cross given(VertexKind::kCorner, 10), movable(VertexKind::kCurve, 10);
  FutileMending futile(1);
  const auto raise = [&futile](Cross& cross) {
    return raise_shapes(cross.quads, cross.input, cross.features, *cross.index, ImproveOptions{}, RunContext{}, nullptr, nullptr,
                        &futile);
  };
  EXPECT_EQ(raise(given), 0);
  const QuadMesh before = movable.quads;
  ASSERT_EQ(before.positions, given.quads.positions);
  EXPECT_EQ(raise(movable), 0) << "the same place";
  EXPECT_EQ(movable.quads.positions, before.positions);
  futile = FutileMending(1);
  EXPECT_GT(raise(movable), 0);
}

TEST(RaiseShapes, VerticesSlideAlongTheirCurves) {
  Cross cross(VertexKind::kCurve, 10);
  ASSERT_TRUE(any_folded(cross.quads));
  EXPECT_GT(raise_shapes(cross.quads, cross.input, cross.features, *cross.index, ImproveOptions{}, RunContext{}), 0);
  EXPECT_FALSE(any_folded(cross.quads));
  for (const int v : {1, 7}) EXPECT_EQ(cross.quads.positions[v].y(), v == 1 ? 0 : kSide);
  for (const int v : {3, 5}) EXPECT_EQ(cross.quads.positions[v].x(), v == 3 ? 0 : kSide);
  EXPECT_EQ(cross.quads.positions[4], Vector3(10, 10, 0));
}

TEST(Workpiece, VerticesOnACurveKeepApart) {
  Cross cross(VertexKind::kCurve, 10);
  Workpiece piece(cross.quads, cross.input, cross.features, *cross.index);
  piece.locate_all();
  constexpr int kHalfway = 5;
  for (const int direction : {1, -1}) {
    const double gap = piece.gap(kHalfway, direction);
    EXPECT_DOUBLE_EQ(gap, kSide / 2);
    EXPECT_DOUBLE_EQ(piece.room(kHalfway, direction, 1), 0.8 * gap);
    EXPECT_DOUBLE_EQ(piece.room(kHalfway, direction, 30), gap - 3);
    EXPECT_DOUBLE_EQ(piece.room(kHalfway, direction, 100), 0);
  }
}

}  // namespace
}  // namespace hybrid_quad
