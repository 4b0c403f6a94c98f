#include <gtest/gtest.h>

#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {
namespace {

/// 3 x 3 quads, the middle one with corners 5, 6, 10, 9.
QuadMesh nine_quads() {
  QuadMesh mesh;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      mesh.positions.emplace_back(i, j, 0);
      mesh.kind.push_back(VertexKind::kFree);
      mesh.anchor.push_back(0);
      mesh.near_face.push_back(-1);
    }
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) mesh.quads.push_back({4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4});
  return mesh;
}

double upward_area(const QuadMesh& mesh, int q) {
  const auto& v = mesh.quads[q];
  return 0.5 * (mesh.positions[v[2]] - mesh.positions[v[0]]).cross(mesh.positions[v[3]] - mesh.positions[v[1]]).z();
}

TEST(FlatQuads, GetAnAreaOnTheRightSide) {
  const std::vector<std::array<Vector3, 4>> flat = {
      {Vector3(1, 1, 0), Vector3(1, 1, 0), Vector3(1, 1, 0), Vector3(1, 1, 0)},                  // a point
      {Vector3(1, 1, 0), Vector3(1.4, 1, 0), Vector3(2, 1, 0), Vector3(1.7, 1, 0)},              // a line
      {Vector3(1.5, 1.5, 0), Vector3(2, 1, 0), Vector3(1.5, 1.5, 0), Vector3(1, 2, 0)},          // a diagonal of no length
      {Vector3(2, 1, 0), Vector3(1.5, 1.5, 0), Vector3(1, 2, 0), Vector3(1.5, 1.5, 0)},          // the other one
  };
  for (std::size_t i = 0; i < flat.size(); ++i) {
    QuadMesh mesh = nine_quads();
    for (int c = 0; c < 4; ++c) mesh.positions[mesh.quads[4][c]] = flat[i][c];
    EXPECT_EQ(open_flat_quads(mesh, 1), 1) << i;
    EXPECT_GT(upward_area(mesh, 4), 1e-10) << i;
    for (int c = 0; c < 4; ++c) EXPECT_LT((mesh.positions[mesh.quads[4][c]] - flat[i][c]).norm(), 1e-3) << i;
    EXPECT_EQ(open_flat_quads(mesh, 1), 0) << i;
  }
}

TEST(FlatQuads, AreFoundAtAnyScale) {
  for (const double scale : {1e-200, 1e-30, 1.0, 1e30, 1e200}) {
    QuadMesh mesh = nine_quads();
    for (Vector3& p : mesh.positions) p *= scale;
    EXPECT_TRUE(quads_without_area(mesh).empty()) << scale;
    const auto& quad = mesh.quads[4];
    mesh.positions[quad[0]] = 0.5 * (mesh.positions[quad[1]] + mesh.positions[quad[3]]);
    mesh.positions[quad[2]] = mesh.positions[quad[0]];
    EXPECT_EQ(quads_without_area(mesh), std::vector<int>{4}) << scale;
  }
}

TEST(FlatQuads, FreeVerticesMoveFirst) {
  QuadMesh mesh = nine_quads();
  const auto quad = mesh.quads[4];
  for (const int v : {quad[0], quad[1], quad[2]}) mesh.kind[v] = VertexKind::kCorner;
  mesh.positions[quad[3]] = {1.5, 1, 0};
  mesh.positions[quad[2]] = {1.8, 1, 0};
  const QuadMesh before = mesh;
  EXPECT_EQ(open_flat_quads(mesh, 1), 1);
  for (const int v : {quad[0], quad[1], quad[2]}) EXPECT_EQ(mesh.positions[v], before.positions[v]);
}

TEST(FlatQuads, SmallOnesCountAsPartOfSomethingLarge) {
  QuadMesh mesh = nine_quads();
  for (Vector3& p : mesh.positions) p *= 1e-6;
  EXPECT_EQ(open_flat_quads(mesh, 1e-6), 0);
  EXPECT_GT(open_flat_quads(mesh, 1), 0);
  for (int q = 0; q < 9; ++q) EXPECT_GT(std::abs(upward_area(mesh, q)), 1e-10);
}

TEST(FlatQuads, StepsAreShortBesideSmallQuads) {
  constexpr double kSize = 1e-4;
  QuadMesh mesh = nine_quads();
  mesh.positions[mesh.quads[4][0]] = {1, 2, 0};  // the middle one is a line now
  mesh.positions[mesh.quads[4][1]] = {2, 2, 0};
  for (Vector3& p : mesh.positions) p *= kSize;
  ASSERT_EQ(upward_area(mesh, 4), 0);
  EXPECT_EQ(open_flat_quads(mesh, 1), 1);
  for (int q = 0; q < 9; ++q) EXPECT_GT(upward_area(mesh, q), 1e-10) << q;
}

TEST(FlatQuads, GoodOnesStay) {
  QuadMesh mesh = nine_quads();
  const QuadMesh before = mesh;
  EXPECT_EQ(open_flat_quads(mesh, 1), 0);
  EXPECT_EQ(mesh.positions, before.positions);
}

TEST(FlatQuads, NoneAroundIsTurnedOver) {
  const TriangleMesh sheet({{-1, -1, 0}, {4, -1, 0}, {4, 4, 0}, {-1, 4, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const SurfaceIndex index(sheet, {});
  QuadMesh mesh = nine_quads();
  const auto quad = mesh.quads[4];
  mesh.positions[quad[0]] = {1.5, 1.5, 0};
  mesh.positions[quad[2]] = {1.5, 1.5, 0};
  // The quad beyond the end that usually moves is smaller than the step is long.
  for (const int v : {11, 14, 15}) mesh.positions[v] = Vector3(1.5, 1.5, 0) + 5e-5 * (mesh.positions[v] - Vector3(2, 2, 0));
  QuadMesh blind = mesh;
  open_flat_quads(blind, 1);
  EXPECT_GT(flawed_quads(blind, index).size(), 0u);
  EXPECT_GT(open_flat_quads(mesh, 1, &index), 0);
  EXPECT_EQ(flawed_quads(mesh, index), std::vector<int>());
}

}  // namespace
}  // namespace hybrid_quad
