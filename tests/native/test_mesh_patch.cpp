#include <gtest/gtest.h>

#include "hybrid_quad/improve/mesh_patch.h"

namespace hybrid_quad {
namespace {

constexpr int kSide = 4;

int id(int i, int j) { return (kSide + 1) * j + i; }

/// Even quads on a square, with a feature across.
QuadMesh grid() {
  QuadMesh mesh;
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) {
      mesh.positions.emplace_back(i, j, 0);
      mesh.kind.push_back(j == 2 ? VertexKind::kCurve : VertexKind::kFree);
      mesh.anchor.push_back(j);
      mesh.near_face.push_back(10 * i);
    }
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) mesh.quads.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
  for (int i = 0; i < kSide; ++i) mesh.feature_edges.push_back({id(i, 2), id(i + 1, 2), 3});
  return mesh;
}

void expect_same(const QuadMesh& x, const QuadMesh& y) {
  EXPECT_EQ(x.positions, y.positions);
  EXPECT_EQ(x.quads, y.quads);
  EXPECT_EQ(x.kind, y.kind);
  EXPECT_EQ(x.anchor, y.anchor);
  EXPECT_EQ(x.near_face, y.near_face);
  ASSERT_EQ(x.feature_edges.size(), y.feature_edges.size());
  for (std::size_t e = 0; e < x.feature_edges.size(); ++e) {
    EXPECT_EQ(x.feature_edges[e].a, y.feature_edges[e].a);
    EXPECT_EQ(x.feature_edges[e].b, y.feature_edges[e].b);
    EXPECT_EQ(x.feature_edges[e].curve, y.feature_edges[e].curve);
  }
}

TEST(MeshPatch, WhatDidNotChangeIsPutBackAsItWas) {
  QuadMesh mesh = grid();
  put_back(cut_patch(mesh, {5, 6, 9}), mesh);
  expect_same(mesh, grid());
}

TEST(MeshPatch, HasItsQuadsTheirVerticesAndFeatureEdgesAlongThem) {
  const QuadMesh mesh = grid();
  const MeshPatch patch = cut_patch(mesh, {1, 5, 9});  // a column
  EXPECT_EQ(patch.mesh.positions.size(), 8u);
  EXPECT_TRUE(violations_of(patch.mesh).empty());
  ASSERT_EQ(patch.feature_edges, std::vector<int>{1});
  for (std::size_t k = 0; k < patch.quads.size(); ++k)
    for (int i = 0; i < 4; ++i) EXPECT_EQ(patch.vertices[patch.mesh.quads[k][i]], mesh.quads[patch.quads[k]][i]);
  // Of edge 1 the patch has both ends, and no quad beside it.
  EXPECT_EQ(cut_patch(mesh, {8, 10}).feature_edges, (std::vector<int>{0, 2}));
}

TEST(MeshPatch, WhatIsNewComesLast) {
  QuadMesh mesh = grid();
  MeshPatch patch = cut_patch(mesh, {5, 9});
  // The upper quad gets a smaller one inside.
  const std::array<int, 4> around = patch.mesh.quads[1];
  const int first = static_cast<int>(patch.mesh.positions.size());
  for (const int v : around) {
    patch.mesh.positions.push_back(0.5 * (patch.mesh.positions[v] + Vector3(1.5, 2.5, 0)));
    patch.mesh.kind.push_back(VertexKind::kFree);
    patch.mesh.anchor.push_back(7);
    patch.mesh.near_face.push_back(-1);
  }
  patch.mesh.quads[1] = {first, first + 1, first + 2, first + 3};
  for (int i = 0; i < 4; ++i) patch.mesh.quads.push_back({around[i], around[(i + 1) & 3], first + ((i + 1) & 3), first + i});
  patch.mesh.feature_edges.push_back({around[0], first, 4});
  put_back(patch, mesh);
  const QuadMesh before = grid();
  EXPECT_EQ(mesh.quads.size(), before.quads.size() + 4);
  EXPECT_EQ(mesh.positions.size(), before.positions.size() + 4);
  EXPECT_TRUE(violations_of(mesh).empty());
  for (std::size_t q = 0; q < before.quads.size(); ++q)
    if (q != 9) { EXPECT_EQ(mesh.quads[q], before.quads[q]); }
  const int fresh = static_cast<int>(before.positions.size());
  EXPECT_EQ(mesh.quads[9], (std::array<int, 4>{fresh, fresh + 1, fresh + 2, fresh + 3}));
  EXPECT_EQ(mesh.feature_edges.back().a, id(1, 2));
  EXPECT_EQ(mesh.feature_edges.back().b, fresh);
}

}  // namespace
}  // namespace hybrid_quad
