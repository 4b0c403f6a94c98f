#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hybrid_quad/mesh/polychord_collapse.h"
#include "hybrid_quad/mesh/quad_count.h"
#include "support/quad_complexes.h"

namespace hybrid_quad {
namespace {

using namespace test;

int irregular(const QuadComplex& c) {
  std::vector<int> corners(c.positions.size(), 0);
  std::vector<char> border(c.positions.size(), 0);
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d) {
    ++corners[c.from(d)];
    if (c.opposite[d] < 0) border[c.from(d)] = border[c.to(d)] = 1;
  }
  int count = 0;
  for (std::size_t v = 0; v < corners.size(); ++v) count += !border[v] && corners[v] != 4;
  return count;
}

void expect_sound(const QuadComplex& c, const QuadComplex& before) {
  EXPECT_TRUE(violations_of(c).empty());
  EXPECT_TRUE(violations_of(to_quad_mesh(c)).empty());
  EXPECT_EQ(euler_characteristic(c), euler_characteristic(before));
  EXPECT_EQ(border_loop_lengths(c).size(), border_loop_lengths(before).size());
  EXPECT_EQ(euler_characteristic(to_quad_mesh(c)), euler_characteristic(before));
}

std::vector<char> only(const Polychords& polychords, std::size_t id) {
  std::vector<char> chosen(polychords.length.size(), 0);
  chosen[id] = 1;
  return chosen;
}

TEST(QuadCount, RowsMeetNumbersBetweenThoseOfGrids) {
  for (const double wanted : {240.0, 290.0, 340.0, 380.0}) {
    QuadComplex c = quad_torus(20, 15);
    const QuadComplex before = c;
    const int rows = fit_quad_count(c, wanted, 10, {});
    EXPECT_LE(std::abs(c.quad_count() - wanted), 10) << wanted;
    EXPECT_EQ(rows > 0, std::abs(300 - wanted) > 10);
    EXPECT_EQ(irregular(c), 0);
    expect_sound(c, before);
  }
}

TEST(QuadCount, TakesNoMoreThanAThird) {
  QuadComplex c = quad_torus(20, 15);
  fit_quad_count(c, 20, 5, {});
  EXPECT_GE(c.quad_count(), 200);
  fit_quad_count(c, 5000, 5, {});
  EXPECT_LE(c.quad_count(), 400);
}

TEST(QuadCount, NoRowIsLeftThatMayGo) {
  QuadComplex c = quad_box(6, 5, 4);
  const double before = c.quad_count();
  fit_quad_count(c, 1, 0, {});
  const double room = before / 3 - (before - c.quad_count());
  const Polychords polychords = trace_polychords(c);
  ASSERT_GT(polychords.length.size(), 0u);
  for (std::size_t id = 0; id < polychords.length.size(); ++id) {
    if (polychords.length[id] > room) continue;
    QuadComplex fewer = c;
    EXPECT_FALSE(collapse_polychords(fewer, polychords, only(polychords, id))) << id;
  }
}

TEST(QuadCount, RowsThatAreApartGoAsIfOneByOne) {
  // Around a tube the rows taper: the narrow ones have others like them beside them, which grow wider as they go.
  QuadComplex c = quad_tube(12, 90);
  for (Vector3& p : c.positions) p[2] = 40 * (1 - std::exp(-p[2] / 40));
  const QuadComplex before = c;
  const double wanted = 12 * 75;
  EXPECT_EQ(fit_quad_count(c, wanted, 5, {}), 15);
  EXPECT_EQ(c.quad_count(), wanted);
  expect_sound(c, before);
  double narrowest = 1e9;
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d) {
    const double height = std::abs(c.positions[c.to(d)][2] - c.positions[c.from(d)][2]);
    if (height > 1e-9) narrowest = std::min(narrowest, height);
  }
  EXPECT_GT(narrowest, 0.12);  // 0.11 before
}

TEST(QuadCount, AnswersARequestToStop) {
  QuadComplex c = quad_torus(20, 15);
  RunContext context;
  context.stop_requested = [] { return true; };
  EXPECT_THROW(fit_quad_count(c, 240, 5, {}, context), Cancelled);
}

TEST(QuadCount, BoxesKeepTheirCorners) {
  QuadComplex c = quad_box(8, 6, 5);
  const QuadComplex before = c;
  fit_quad_count(c, 0.8 * before.quad_count(), 8, {});
  EXPECT_LT(c.quad_count(), before.quad_count());
  EXPECT_EQ(irregular(c), 8);
  expect_sound(c, before);
}

TEST(QuadCount, HolesStayOpen) {
  // The quad in the middle is a hole between two corners, and the rows to either side of it are the narrowest.
  constexpr int kSize = 7, kMiddle = 3;
  const auto at = [](int x, int y) { return y * (kSize + 1) + x; };
  std::vector<Vector3> positions;
  std::vector<std::array<int, 4>> quads;
  for (int y = 0; y <= kSize; ++y)
    for (int x = 0; x <= kSize; ++x) positions.push_back(Vector3(x > kMiddle ? x - 0.9 : x, y, 0));
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (x != kMiddle || y != kMiddle) quads.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
  QuadComplex c = complex_of_quads(positions, quads);
  const std::array<int, 4> hole{at(kMiddle, kMiddle), at(kMiddle + 1, kMiddle), at(kMiddle + 1, kMiddle + 1), at(kMiddle, kMiddle + 1)};
  for (int i = 0; i < 4; ++i) c.kind[hole[i]] = i % 2 ? VertexKind::kCurve : VertexKind::kCorner;
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d)
    for (int i = 0; i < 4; ++i)
      if (c.to(d) == hole[i] && c.from(d) == hole[(i + 1) % 4]) c.curve[d] = i / 2;
  const QuadComplex before = c;
  fit_quad_count(c, 42, 1, {});
  EXPECT_LT(c.quad_count(), before.quad_count());
  expect_sound(c, before);
}

TEST(QuadCount, WideQuadsAreSplitAndNarrowOnesGo) {
  // Columns of the plane's grid that are wider, or narrower, than the others.
  for (const bool wide : {true, false}) {
    QuadComplex c = quad_grid(12, 10);
    for (Vector3& p : c.positions)
      if (p[0] > 5.5) p[0] += wide ? 3 : -0.8;
    const double wanted = wide ? 130 : 110;
    fit_quad_count(c, wanted, 2, {});
    EXPECT_EQ(c.quad_count(), wanted);
    double longest = 0, shortest = 1e9;
    for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d) {
      const double length = (c.positions[c.to(d)] - c.positions[c.from(d)]).norm();
      longest = std::max(longest, length);
      shortest = std::min(shortest, length);
    }
    if (wide) EXPECT_LT(longest, 2.5);
    else EXPECT_GT(shortest, 0.5);
  }
}

TEST(QuadCount, CountedCurvesKeepTheirNumberOfEdges) {
  QuadComplex c = quad_grid(12, 10);
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d)
    if (c.opposite[d] < 0) {
      c.curve[d] = std::abs(c.positions[c.to(d)][0] - c.positions[c.from(d)][0]) > 0.5 ? 0 : 1;
      for (const int v : {c.from(d), c.to(d)})
        if (c.kind[v] == VertexKind::kFree) c.kind[v] = VertexKind::kCurve;
    }
  const auto edges = [](const QuadComplex& complex, int curve) { return std::count(complex.curve.begin(), complex.curve.end(), curve); };
  const auto before = edges(c, 0);
  fit_quad_count(c, 150, 6, {1, 0});
  EXPECT_EQ(edges(c, 0), before);
  EXPECT_GT(c.quad_count(), 140);
}

TEST(PolychordCollapse, RefusesWhatWouldBreak) {
  // A tube of four quads around, and a torus of three rows: one row fewer is no indexed mesh.
  for (QuadComplex c : {quad_tube(4, 6), quad_torus(3, 8)}) {
    const QuadComplex before = c;
    const Polychords rows = trace_polychords(c);
    for (std::size_t id = 0; id < rows.length.size(); ++id) {
      QuadComplex changed = before;
      if (collapse_polychords(changed, rows, only(rows, id))) expect_sound(changed, before);
      else EXPECT_EQ(changed.quad_count(), before.quad_count());
    }
  }
  QuadComplex cube = quad_box(1, 1, 1);
  const Polychords rows = trace_polychords(cube);
  for (std::size_t id = 0; id < rows.length.size(); ++id) EXPECT_FALSE(collapse_polychords(cube, rows, only(rows, id)));
}

TEST(PolychordCollapse, KeepsCornersApart) {
  QuadComplex c = quad_grid(1, 5);
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d)
    if (c.opposite[d] < 0) c.kind[c.from(d)] = VertexKind::kCorner;
  const Polychords rows = trace_polychords(c);
  for (std::size_t id = 0; id < rows.length.size(); ++id) EXPECT_FALSE(collapse_polychords(c, rows, only(rows, id)));
}

}  // namespace
}  // namespace hybrid_quad
