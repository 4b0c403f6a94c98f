#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/tip_pulls.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

constexpr double kWidth = 0.5, kLength = 6;
constexpr int kRings = 6;

FeatureGraph no_creases(const TriangleMesh& mesh) {
  FeatureOptions options;
  options.use_sharp_angle = false;
  return detect_features(mesh, options, RunContext{});
}

/// A stick, and quads twice as long as wide around it: a ring of four an edge length, one at either end.
struct Stick {
  Stick() : input(test::box(24, Vector3(kWidth, kWidth, kLength))), features(no_creases(input)), index(input, features.face_region) {
    for (int ring = 0; ring <= kRings; ++ring)
      for (const auto& [x, y] : {std::pair{0.0, 0.0}, {kWidth, 0.0}, {kWidth, kWidth}, {0.0, kWidth}})
        quads.positions.emplace_back(x, y, ring * kLength / kRings);
    for (int ring = 0; ring < kRings; ++ring)
      for (int i = 0; i < 4; ++i) {
        const int a = 4 * ring + i, b = 4 * ring + (i + 1) % 4;
        quads.quads.push_back({a, b, b + 4, a + 4});
      }
    const int top = 4 * kRings;
    quads.quads.push_back({3, 2, 1, 0});
    quads.quads.push_back({top, top + 1, top + 2, top + 3});
    const std::size_t n = quads.positions.size();
    quads.kind.assign(n, VertexKind::kFree);
    quads.anchor.assign(n, features.face_region[0]);
    for (const Vector3& p : quads.positions) quads.near_face.push_back(index.nearest(p).face);
  }

  /// \returns how long the quads are after smoothing
  double smoothed_length(bool hold) const {
    Workpiece piece(quads, input, features, index);
    piece.bind_all();
    TipPulls tips(piece);
    SmootherOptions options;
    if (hold) options.tips = &tips;
    Smoother(piece, options).smooth(40, RunContext{});
    const auto is_lower = [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); };
    const auto [low, high] = std::minmax_element(piece.mesh.positions.begin(), piece.mesh.positions.end(), is_lower);
    return high->z() - low->z();
  }

  TriangleMesh input;
  FeatureGraph features;
  SurfaceIndex index;
  QuadMesh quads;
};

TEST(TipPulls, AreAtBothEndsOfAStick) {
  const Stick stick;
  ASSERT_TRUE(violations_of(stick.quads).empty());
  Workpiece piece(stick.quads, stick.input, stick.features, stick.index);
  piece.bind_all();
  const std::vector<Vector3> points = TipPulls(piece).points();
  const auto is_at = [](double z) { return [z](const Vector3& p) { return std::abs(p.z() - z) < 1e-9; }; };
  const auto low = std::count_if(points.begin(), points.end(), is_at(0)), high = std::count_if(points.begin(), points.end(), is_at(kLength));
  EXPECT_GT(low, 0);
  EXPECT_GT(high, 0);
  EXPECT_EQ(low + high, static_cast<long>(points.size()));
}

TEST(TipPulls, AreNotWhereQuadsAreFlatOrFoldedInThePlane) {
  const TriangleMesh input = test::flat_grid(20, 20, 8, 8);
  const FeatureGraph features = no_creases(input);
  const SurfaceIndex index(input, features.face_region);
  QuadMesh quads = test::even_quads(8, features.face_region[0]);
  // A vertex beyond its neighbours: the angles there add up to far less than a full turn, though all is flat.
  const auto inner = std::find_if(quads.positions.begin(), quads.positions.end(), [](const Vector3& p) { return (p - Vector3(4, 4, 0)).norm() < 1e-9; });
  ASSERT_NE(inner, quads.positions.end());
  for (const double shift : {0.0, 3.0}) {
    *inner = Vector3(4 + shift, 4 + shift, 0);
    Workpiece piece(quads, input, features, index);
    piece.bind_all();
    EXPECT_TRUE(TipPulls(piece).points().empty()) << shift;
  }
}

TEST(TipPulls, HoldQuadsThatWouldSlipOffAStick) {
  const Stick stick;
  EXPECT_LT(stick.smoothed_length(false), 0.95 * kLength);
  EXPECT_GT(stick.smoothed_length(true), 0.99 * kLength);
}

TEST(TipPulls, GoToAnotherQuadWhereTheirsIsGone) {
  const Stick stick;
  Workpiece piece(stick.quads, stick.input, stick.features, stick.index);
  piece.bind_all();
  TipPulls tips(piece);
  const int last = piece.mesh.quad_count() - 1;
  const EditMesh::Quad corners = piece.mesh.quad(last);
  piece.mesh.set_quad(last, corners, false);
  tips.attach(piece.mesh);
  double stiffness = 0;
  for (const int v : corners) {
    GuidePull sum;
    tips.pulls().add_to(sum, v, piece.mesh.positions, 1);
    stiffness += sum.stiffness.trace();
  }
  EXPECT_GT(stiffness, 1);
}

}  // namespace
}  // namespace hybrid_quad
