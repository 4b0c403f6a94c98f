#include <gtest/gtest.h>

#include <memory>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/side_splitting.h"
#include "hybrid_quad/quality/quality.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

constexpr int kWidth = 20, kHeight = 10;

int id(int x, int y) { return (kWidth + 1) * y + x; }

/// A sheet with an arch of marked edges, up from (5, 5), along y = 9 and down to (15, 5), and five quads of which one lies between
/// the arch, cut off by a single edge, and (7, 7), (13, 7): as straight as its sides are, it is turned over.
struct Arch {
  Arch() : input(test::flat_grid(kWidth, kHeight, kWidth, kHeight)) {
    FeatureOptions options;
    options.corner_angle = 10;
    options.corners = {id(0, 0), id(kWidth, 0), id(kWidth, kHeight), id(0, kHeight)};
    for (int y = 5; y < 9; ++y) {
      options.marked_edges.push_back({id(5, y), id(5, y + 1)});
      options.marked_edges.push_back({id(15, y), id(15, y + 1)});
    }
    for (int x = 5; x < 15; ++x) options.marked_edges.push_back({id(x, 9), id(x + 1, 9)});
    features = detect_features(input, options, RunContext{});
    index = std::make_unique<SurfaceIndex>(input, features.face_region);
    for (const int v : {id(5, 5), id(15, 5), id(13, 7), id(7, 7), id(kWidth, kHeight), id(0, kHeight), id(0, 0), id(kWidth, 0)}) {
      const bool is_free = v == id(13, 7) || v == id(7, 7);
      quads.positions.push_back(input.position(v));
      quads.kind.push_back(is_free ? VertexKind::kFree : VertexKind::kCorner);
      quads.anchor.push_back(is_free ? features.face_region[0] : v);
      quads.near_face.push_back(-1);
    }
    quads.quads = {{0, 1, 4, 5}, {0, 3, 2, 1}, {0, 5, 6, 3}, {6, 7, 2, 3}, {7, 4, 1, 2}};
    for (int c = 0; c < static_cast<int>(features.curves.size()); ++c) {
      const std::vector<int>& along = features.curves[c].vertices;
      const auto vertex = [&](int v) {
        int found = 0;
        while (quads.kind[found] != VertexKind::kCorner || quads.anchor[found] != v) ++found;
        return found;
      };
      quads.feature_edges.push_back({vertex(along.front()), vertex(along.back()), c});
    }
  }

  TriangleMesh input;
  FeatureGraph features;
  std::unique_ptr<SurfaceIndex> index;
  QuadMesh quads;
};

int split(Arch& arch) { return split_flawed_quads(arch.quads, arch.input, arch.features, *arch.index, ImproveOptions{}, Agreement{}, RunContext{}); }

TEST(SplitFlawed, AnArchThatOneEdgeCutsOffGetsVertices) {
  Arch arch;
  ASSERT_EQ(arch.features.curves.size(), 5u);
  ASSERT_TRUE(violations_of(arch.quads).empty());
  ASSERT_EQ(flawed_quads(arch.quads, *arch.index, {}), std::vector<int>{1});
  const QuadMesh before = arch.quads;
  EXPECT_EQ(split(arch), 1);
  EXPECT_TRUE(flawed_quads(arch.quads, *arch.index, {}).empty());
  EXPECT_TRUE(violations_of(arch.quads).empty());
  for (std::size_t v = 0; v < before.positions.size(); ++v) EXPECT_EQ(arch.quads.positions[v], before.positions[v]);
  int on_arch = 0;
  for (std::size_t v = before.positions.size(); v < arch.quads.positions.size(); ++v) {
    if (arch.quads.kind[v] != VertexKind::kCurve) continue;
    ++on_arch;
    const Vector3& p = arch.quads.positions[v];
    EXPECT_TRUE(p.y() == 9 || ((p.x() == 5 || p.x() == 15) && p.y() >= 5)) << p.transpose();
  }
  EXPECT_EQ(on_arch, 2);
  EXPECT_EQ(arch.quads.feature_edges.size(), before.feature_edges.size() + 2);
}

TEST(SplitFlawed, NotWhereTheNumberOfEdgesIsAsked) {
  Arch arch;
  for (FeatureCurve& curve : arch.features.curves) curve.asked_count = 1;
  const QuadMesh before = arch.quads;
  split(arch);
  EXPECT_EQ(arch.quads.feature_edges.size(), before.feature_edges.size());
}

TEST(SplitFlawed, SoundQuadsStay) {
  Arch arch;
  arch.quads.positions[2] = {13, 3, 0};
  arch.quads.positions[3] = {7, 3, 0};
  ASSERT_TRUE(flawed_quads(arch.quads, *arch.index, {}).empty());
  EXPECT_EQ(split(arch), 0);
  EXPECT_EQ(arch.quads.quads.size(), 5u);
}

TEST(SplitFlawed, AnySoundSplitLeavesAValidMesh) {
  const Arch arch;
  const SideSplitter splitter(arch.quads, *arch.index, std::vector<int>(arch.quads.quads.size(), -1));
  const std::array<HexagonFill, 5> fills{HexagonFill::kFirstEdge, HexagonFill::kSecondEdge, HexagonFill::kStarAtFirst, HexagonFill::kStarAtSecond,
                                         HexagonFill::kInset};
  int sound = 0, on_boundary = 0;
  for (int q = 0; q < static_cast<int>(arch.quads.quads.size()); ++q)
    for (int side = 0; side < 4; ++side)
      for (const HexagonFill fill : fills)
        for (const HexagonFill across : fills) {
          const SideSplit split{q, side, 1.0 / 3, 2.0 / 3, fill, across};
          const bool is_boundary = splitter.across(q, side) < 0;
          const Vector3 &a = arch.quads.positions[arch.quads.quads[q][side]], &b = arch.quads.positions[arch.quads.quads[q][(side + 1) & 3]];
          std::vector<int> changed;
          const QuadMesh mesh = splitter.split(split, {a, (2 * a + b) / 3, (a + 2 * b) / 3, b}, &changed);
          EXPECT_EQ(changed.size(), mesh.quads.size() - arch.quads.quads.size() + (is_boundary ? 1 : 2));
          // And the other way round: what is not sound is not valid, but on the boundary, where two quads are too few only for shape.
          if (is_sound(split, is_boundary)) {
            EXPECT_TRUE(violations_of(mesh).empty()) << q << ' ' << side;
            ++sound;
            on_boundary += is_boundary;
          } else if (!is_boundary) {
            EXPECT_FALSE(violations_of(mesh).empty()) << q << ' ' << side;
          }
        }
  EXPECT_GT(sound, 0);
  EXPECT_GT(on_boundary, 0);
}

}  // namespace
}  // namespace hybrid_quad
