#include <gtest/gtest.h>

#include <limits>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/quad_complex.h"
#include "support/quad_complexes.h"

namespace hybrid_quad {
namespace {

using namespace test;

TEST(QuadComplex, IndexedQuadsGlueAlongTheirSides) {
  const QuadComplex box = quad_box(2, 3, 4), grid = quad_grid(3, 2);
  EXPECT_TRUE(violations_of(box).empty());
  EXPECT_TRUE(violations_of(grid).empty());
  EXPECT_EQ(euler_characteristic(box), 2);
  EXPECT_EQ(euler_characteristic(grid), 1);
  EXPECT_EQ(border_loop_lengths(grid), std::vector<int>{10});
  EXPECT_TRUE(violations_of(to_quad_mesh(box)).empty());
  EXPECT_TRUE(violations_of(to_quad_mesh(grid)).empty());
}

TEST(QuadComplex, GluingsThatVertexPairsCannotTellApartAreStillComplexes) {
  for (const QuadComplex& c :
       {quad_tube(1, 1), quad_tube(2, 3), quad_torus(1, 1), quad_torus(2, 1), pillow()}) {
    EXPECT_TRUE(violations_of(c).empty());
    EXPECT_FALSE(violations_of(to_quad_mesh(c)).empty());
  }
  EXPECT_EQ(euler_characteristic(quad_torus(1, 1)), 0);
  EXPECT_EQ(euler_characteristic(pillow()), 2);
  EXPECT_EQ(border_loop_lengths(quad_tube(1, 2)), (std::vector<int>{1, 1}));
}

TEST(QuadComplex, EveryBrokenPromiseIsSeen) {
  const QuadComplex good = quad_box(2, 2, 2);
  const auto broken = [&](auto&& damage) {
    QuadComplex c = good;
    damage(c);
    return !violations_of(c).empty();
  };
  EXPECT_TRUE(broken([](QuadComplex& c) { c.opposite[0] = -1; }));
  EXPECT_TRUE(broken([](QuadComplex& c) { std::swap(c.opposite[0], c.opposite[1]); }));
  EXPECT_TRUE(broken([](QuadComplex& c) { c.opposite[3] = 3; }));
  EXPECT_TRUE(broken([](QuadComplex& c) { c.opposite[3] = 1000; }));
  EXPECT_TRUE(broken([](QuadComplex& c) { c.vertex[5] = c.vertex[6]; }));
  EXPECT_TRUE(broken([](QuadComplex& c) { c.vertex[5] = -2; }));
  EXPECT_TRUE(broken([](QuadComplex& c) { c.curve[0] = 4; }));
  EXPECT_TRUE(broken([](QuadComplex& c) { c.curve.pop_back(); }));
  EXPECT_TRUE(broken([](QuadComplex& c) { c.anchor.pop_back(); }));
  EXPECT_TRUE(broken([](QuadComplex& c) { c.near_face.pop_back(); }));
  EXPECT_TRUE(broken([](QuadComplex& c) { c.positions[0].x() = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(broken([](QuadComplex& c) {  // a vertex that nothing uses
    c.positions.push_back(Vector3(9, 9, 9));
    c.kind.push_back(VertexKind::kFree);
    c.anchor.push_back(0);
    c.near_face.push_back(-1);
  }));
  EXPECT_TRUE(broken([](QuadComplex& c) {  // two fans under one number
    for (int& v : c.vertex)
      if (v == 7) v = 0;
  }));
  EXPECT_THROW(complex_of_quads(good.positions, {{0, 1, 2, 3}, {0, 1, 4, 5}}), InternalError);
}

TEST(QuadMesh, EveryBrokenPromiseIsSeen) {
  const QuadMesh good = to_quad_mesh(quad_box(2, 2, 2));
  const auto broken = [&](auto&& damage) {
    QuadMesh m = good;
    damage(m);
    return !violations_of(m).empty();
  };
  EXPECT_TRUE(broken([](QuadMesh& m) { m.quads[0][1] = m.quads[0][2]; }));
  EXPECT_TRUE(broken([](QuadMesh& m) { std::swap(m.quads[0][1], m.quads[0][3]); }));  // flipped
  EXPECT_TRUE(broken([](QuadMesh& m) { m.quads.push_back(m.quads[0]); }));
  EXPECT_TRUE(broken([](QuadMesh& m) {
    m.quads[0][0] = 26;
    m.quads[0][2] = 99;
  }));
  EXPECT_TRUE(broken([](QuadMesh& m) { m.kind.pop_back(); }));
  EXPECT_TRUE(broken([](QuadMesh& m) { m.positions[3].y() = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(broken([](QuadMesh& m) { m.feature_edges.push_back({m.quads[0][0], m.quads[0][2], 0}); }));
  QuadMesh two = to_quad_mesh(quad_grid(2, 2));
  two.quads = {two.quads[0], two.quads[3]};  // two quads that meet in one vertex, four vertices loose
  EXPECT_GE(violations_of(two).size(), 3u);
}

TEST(QuadComplex, FeatureEdgesAreListedOnceInTheDirectionOfADart) {
  QuadComplex c = quad_box(1, 1, 2);
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d)
    if (c.positions[c.from(d)].z() == 1 && c.positions[c.to(d)].z() == 1) {
      c.curve[d] = 3;
      c.kind[c.from(d)] = c.kind[c.to(d)] = VertexKind::kCurve;
    }
  ASSERT_TRUE(violations_of(c).empty());
  const QuadMesh mesh = to_quad_mesh(c);
  EXPECT_EQ(mesh.feature_edges.size(), 4u);
  EXPECT_TRUE(violations_of(mesh).empty());
}

}  // namespace
}  // namespace hybrid_quad
