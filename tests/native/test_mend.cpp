#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hybrid_quad/improve/mend.h"
#include "hybrid_quad/improve/place_search.h"
#include "hybrid_quad/improve/restoration.h"
#include "hybrid_quad/improve/valence_moves.h"
#include "hybrid_quad/quality/quality.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

TriangleMesh waves() {
  const TriangleMesh flat = test::flat_grid(9, 9);
  std::vector<Vector3> positions = flat.positions();
  for (Vector3& p : positions) p.z() = 0.1 * std::sin(9 * p.x()) * std::sin(7 * p.y());
  return TriangleMesh(std::move(positions), flat.faces());
}

struct Sheet {
  explicit Sheet(const TriangleMesh& surface = test::flat_grid(9, 9)) : input(surface), features(detect_features(input, FeatureOptions{}, RunContext{})), index(input, features.face_region) {
    constexpr int kSide = 10;
    for (int j = 0; j <= kSide; ++j)
      for (int i = 0; i <= kSide; ++i) {
        quads.positions.emplace_back(i / 10.0, j / 10.0, 0);
        quads.kind.push_back(VertexKind::kFree);
        quads.anchor.push_back(features.face_region[0]);
        quads.near_face.push_back(-1);
      }
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) quads.quads.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
  }
  static int id(int i, int j) { return 11 * j + i; }

  TriangleMesh input;
  FeatureGraph features;
  SurfaceIndex index;
  QuadMesh quads;
};

TEST(Mend, TurnsFoldedQuadsOver) {
  Sheet sheet;
  // One quad turned over with its surroundings dragged along.
  std::swap(sheet.quads.positions[Sheet::id(4, 4)], sheet.quads.positions[Sheet::id(6, 4)]);
  std::swap(sheet.quads.positions[Sheet::id(4, 6)], sheet.quads.positions[Sheet::id(6, 6)]);
  const std::vector<int> before = flawed_quads(sheet.quads, sheet.index, {1.0});
  ASSERT_FALSE(before.empty());
  Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
  for (int v = 0; v < piece.mesh.vertex_count(); ++v) piece.bind_free(v, Vector3::Zero());
  Smoother smoother(piece, SmootherOptions{});
  EXPECT_GT(mend_flawed(piece, smoother, sheet.index, {1.0}, RunContext{}).mended, 0);
  const QuadMesh after = piece.mesh.extract();
  EXPECT_TRUE(violations_of(after).empty());
  EXPECT_LT(flawed_quads(after, sheet.index, {1.0}).size(), before.size());
}

TEST(Mend, LeavesGoodMeshesAlone) {
  Sheet sheet;
  Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
  Smoother smoother(piece, SmootherOptions{});
  const MendReport report = mend_flawed(piece, smoother, sheet.index, {1.0}, RunContext{});
  EXPECT_EQ(report.mended, 0);
  EXPECT_EQ(report.placed, 0);
  EXPECT_EQ(piece.mesh.extract().positions, sheet.quads.positions);
}

TEST(Smoother, FramesAreThoseOfTheVerticesAsTheyAre) {
  Sheet sheet(waves());
  Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
  piece.bind_all();
  Smoother smoother(piece, SmootherOptions{});
  smoother.smooth(5, RunContext{});
  for (const int v : {Sheet::id(3, 3), Sheet::id(7, 5)}) {  // and all others rest
    piece.mesh.positions[v] += Vector3(0.2, 0.1, 0);
    piece.bind_free(v, Vector3::Zero());
  }
  smoother.update_frames(true);
  // Without faces under its corners a quad has another reference, but not any more once they are back.
  const std::vector<int> faces = piece.face;
  for (const int v : piece.mesh.quad(44)) piece.face[v] = -1;
  smoother.update_frames(true);
  piece.face = faces;
  smoother.update_frames(true);
  const Smoother fresh(piece, SmootherOptions{});
  for (int q = 0; q < piece.mesh.quad_count(); ++q) {
    EXPECT_EQ(smoother.frame(q).reference, fresh.frame(q).reference);
    EXPECT_EQ(smoother.frame(q).area, fresh.frame(q).area);
  }
}

TEST(Workpiece, AVertexStaysOnTheSheetItIsNear) {
  constexpr double kGap = 0.001;
  const TriangleMesh below = test::flat_grid(9, 9);
  std::vector<Vector3> positions(below.positions());
  std::vector<std::array<int, 3>> faces(below.faces());
  const int vertices = below.vertex_count(), count = below.face_count();
  for (int v = 0; v < vertices; ++v) positions.push_back(below.position(v) + Vector3(0, 0, kGap));
  for (int f = 0; f < count; ++f) faces.push_back({faces[f][0] + vertices, faces[f][1] + vertices, faces[f][2] + vertices});
  const TriangleMesh sheets(std::move(positions), std::move(faces));
  const FeatureGraph features = detect_features(sheets, FeatureOptions{}, RunContext{});
  const SurfaceIndex index(sheets, features.face_region);
  Sheet sheet;
  for (Vector3& p : sheet.quads.positions) p.z() = 0.8 * kGap;
  std::fill(sheet.quads.anchor.begin(), sheet.quads.anchor.end(), -1);
  for (const int near : {-1, 0}) {
    std::fill(sheet.quads.near_face.begin(), sheet.quads.near_face.end(), near);
    Workpiece piece(sheet.quads, sheets, features, index);
    piece.bind_all();
    for (const Vector3& p : piece.mesh.positions) EXPECT_NEAR(p.z(), near < 0 ? kGap : 0, 1e-12);
    for (const int f : piece.face) EXPECT_EQ(f < count, near == 0);
  }
}

TEST(Workpiece, LocatingLeavesVerticesWhereTheyAre) {
  Sheet sheet;
  for (Vector3& p : sheet.quads.positions) p.z() = 0.01;
  Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
  piece.locate_all();
  EXPECT_EQ(piece.mesh.positions, sheet.quads.positions);
  for (int v = 0; v < piece.mesh.vertex_count(); ++v) {
    ASSERT_GE(piece.face[v], 0);
    EXPECT_LT((piece.walk(sheet.quads.positions[v], piece.face[v]).position - sheet.quads.positions[v]).norm(), 0.01 + 1e-9);
  }
}

TEST(FutileMending, KnowsAPlaceUntilSomethingNearItChanges) {
  Sheet sheet;
  const Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
  FutileMending futile(piece.h);
  constexpr int kCorner = 0;
  EXPECT_FALSE(futile.knows(piece, kCorner));
  futile.remember(piece, kCorner);
  EXPECT_TRUE(futile.knows(piece, kCorner));
  EXPECT_FALSE(futile.knows(piece, kCorner + 1));
  const auto known_with = [&](int moved) {
    Sheet other;
    other.quads.positions[moved].x() += 0.01;
    std::reverse(other.quads.quads.begin() + 1, other.quads.quads.end());  // what numbers quads have is no matter
    return futile.knows(Workpiece(other.quads, other.input, other.features, other.index), kCorner);
  };
  EXPECT_TRUE(known_with(Sheet::id(9, 9)));
  EXPECT_FALSE(known_with(Sheet::id(2, 2)));
}

TEST(Mend, WhatWasInVainIsNotTriedAgain) {
  Sheet sheet;
  std::swap(sheet.quads.positions[Sheet::id(5, 5)], sheet.quads.positions[Sheet::id(6, 5)]);
  const std::vector<int> flawed = flawed_quads(sheet.quads, sheet.index, {1.0});
  ASSERT_FALSE(flawed.empty());
  for (const bool is_known : {true, false}) {
    Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
    piece.locate_all();
    Smoother smoother(piece, SmootherOptions{});
    smoother.update_frames(true);
    FutileMending futile(piece.h);
    if (is_known)
      for (const int q : flawed) futile.remember(piece, q);
    const int changes = mend_listed(piece, smoother, sheet.index, {1.0}, RunContext{}, flawed, futile);
    EXPECT_EQ(changes == 0, is_known);
    EXPECT_EQ(piece.mesh.extract().positions == sheet.quads.positions, is_known);
  }
}

/// What is left of a fold where the smoother has no way downhill: vertices of a row that passed each other.
TEST(PlaceSearch, FindsPlacesWhereVerticesPassedEachOther) {
  Sheet sheet;
  const QuadMesh good = sheet.quads;
  std::swap(sheet.quads.positions[Sheet::id(5, 5)], sheet.quads.positions[Sheet::id(6, 5)]);
  Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
  for (int v = 0; v < piece.mesh.vertex_count(); ++v) piece.bind_free(v, Vector3::Zero());
  Smoother smoother(piece, SmootherOptions{});
  smoother.update_frames(true);
  const FlawMeasure measure(piece, sheet.index, {1.0});
  const std::vector<int> flawed = flawed_quads(sheet.quads, sheet.index, {1.0});
  ASSERT_FALSE(flawed.empty());
  for (const int q : flawed) search_places(piece, smoother, measure, q);
  const QuadMesh after = piece.mesh.extract();
  EXPECT_TRUE(flawed_quads(after, sheet.index, {1.0}).empty());
  EXPECT_EQ(after.quads, good.quads);
  for (int v = 0; v < piece.mesh.vertex_count(); ++v) {
    const Vector3 p = after.positions[v];
    EXPECT_NEAR(p.z(), 0, 1e-12);
    if ((p - good.positions[v]).norm() > 0.25) ADD_FAILURE() << "vertex " << v << " went far";
  }
}

TEST(PlaceSearch, LeavesWhatItCannotBetter) {
  Sheet sheet;
  Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
  piece.bind_all();
  Smoother smoother(piece, SmootherOptions{});
  smoother.update_frames(true);
  const FlawMeasure measure(piece, sheet.index, {1.0});
  const QuadMesh before = piece.mesh.extract();
  for (int q = 0; q < piece.mesh.quad_count(); ++q) EXPECT_FALSE(search_places(piece, smoother, measure, q));
  EXPECT_EQ(piece.mesh.extract().positions, before.positions);
}

TEST(PlaceSearch, LeavesCornersWhereTheyAre) {
  Sheet sheet;
  sheet.quads.kind.clear();
  sheet.quads.anchor.clear();
  sheet.quads.near_face.clear();
  for (std::size_t v = 0; v < sheet.quads.positions.size(); ++v) {
    const Vector3& p = sheet.quads.positions[v];
    const bool on_border = p.x() < 1e-9 || p.x() > 1 - 1e-9 || p.y() < 1e-9 || p.y() > 1 - 1e-9;
    sheet.quads.kind.push_back(on_border ? VertexKind::kCorner : VertexKind::kFree);
    sheet.quads.anchor.push_back(on_border ? -1 : sheet.features.face_region[0]);
    sheet.quads.near_face.push_back(-1);
  }
  sheet.quads.positions[Sheet::id(5, 1)] = {0.5, -0.05, 0};
  Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
  for (int v = 0; v < piece.mesh.vertex_count(); ++v)
    if (piece.mesh.is_free(v)) piece.bind_free(v, Vector3::Zero());
  Smoother smoother(piece, SmootherOptions{});
  smoother.update_frames(true);
  const FlawMeasure measure(piece, sheet.index, {1.0});
  for (int q = 0; q < piece.mesh.quad_count(); ++q)
    if (measure.is_flawed(q) || measure.lacks_shape(q) > 0) search_places(piece, smoother, measure, q);
  const QuadMesh after = piece.mesh.extract();
  EXPECT_TRUE(flawed_quads(after, sheet.index, {1.0}).empty());
  for (std::size_t v = 0; v < after.positions.size(); ++v)
    if (sheet.quads.kind[v] == VertexKind::kCorner) {
      EXPECT_EQ(after.positions[v], sheet.quads.positions[v]);
    }
}

TEST(Restoration, LocksAroundNewFlawsOnly) {
  Sheet sheet;
  Restoration restoration(sheet.quads, sheet.index, {1.0});
  EXPECT_EQ(restoration.flawed_count(), 0);
  QuadMesh worse = sheet.quads;
  std::swap(worse.positions[Sheet::id(5, 5)], worse.positions[Sheet::id(7, 5)]);
  const std::vector<int> flawed = flawed_quads(worse, sheet.index, {1.0});
  ASSERT_FALSE(flawed.empty());
  EXPECT_TRUE(restoration.give_up_around(worse, flawed));
  EXPECT_GT(restoration.locked_count(), 0);
  EXPECT_LT(restoration.locked_count(), 100);
  EXPECT_TRUE(restoration.locked()[10 * 5 + 5]);
  EXPECT_FALSE(restoration.locked()[0]);

  // What was flawed from the start is no place to go back to.
  Restoration hopeless(worse, sheet.index, {1.0});
  EXPECT_EQ(hopeless.flawed_count(), static_cast<int>(flawed.size()));
  EXPECT_FALSE(hopeless.give_up_around(worse, flawed));
}

TEST(EditMesh, LockedQuadsStayAsTheyAre) {
  Sheet sheet;
  // A turned edge makes four irregular vertices that the moves would remove.
  auto& first = sheet.quads.quads[44];
  auto& second = sheet.quads.quads[45];
  const int a = first[0], b = first[1], c = first[2], d = first[3], x = second[1], y = second[2];
  first = {a, b, x, y};
  second = {a, y, c, d};
  ASSERT_TRUE(violations_of(sheet.quads).empty());
  for (const bool lock : {false, true}) {
    Workpiece piece(sheet.quads, sheet.input, sheet.features, sheet.index);
    if (lock) {
      piece.mesh.lock(44);
      piece.mesh.lock(45);
    }
    piece.bind_all();
    Smoother smoother(piece, SmootherOptions{});
    SequenceMemory memory;
    improve_valences(piece, smoother, memory, RunContext{});
    smoother.smooth(5, RunContext{});
    const bool same = piece.mesh.alive(44) && piece.mesh.quad(44) == first && piece.mesh.alive(45) && piece.mesh.quad(45) == second;
    EXPECT_EQ(same, lock);
    for (const int v : {a, b, c, d, x, y})
      if (lock) {
        EXPECT_EQ(piece.mesh.positions[v], sheet.quads.positions[v]);
      }
  }
}

}  // namespace
}  // namespace hybrid_quad
