#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hybrid_quad/features/parting_angle.h"

namespace hybrid_quad {
namespace {

/// Ever fewer edges of ever larger angles: 1/e of the length every `scale` degrees.
std::vector<BentEdge> tail(double length, double scale) {
  std::vector<BentEdge> edges;
  for (double angle = 0.5; angle < 180; ++angle) edges.push_back({angle, length * std::exp(-angle / scale)});
  return edges;
}

std::vector<BentEdge> with(std::vector<BentEdge> edges, double angle, double length) {
  edges.push_back({angle, length});
  return edges;
}

TEST(PartingAngle, StaysWhereNothingIsJustBelow) {
  std::vector<BentEdge> part;
  for (const double angle : {3.0, 7.5, 12.0, 90.0, 90.0, 60.0, 45.0}) part.push_back({angle, 1});
  for (const double sharp_angle : {20.0, 30.0, 40.0}) EXPECT_EQ(parting_angle(part, sharp_angle), sharp_angle);
  EXPECT_EQ(parting_angle({}, 40), 40);
}

TEST(PartingAngle, LeavesNothingOfARoughSurface) {
  for (const double scale : {5.0, 10.0, 20.0})
    for (const double sharp_angle : {20.0, 40.0, 60.0}) {
      const std::vector<BentEdge> rough = tail(1000, scale);
      const double limit = parting_angle(rough, sharp_angle);
      double left = 0, above = 0;
      for (const BentEdge& e : rough) {
        if (e.angle > sharp_angle) above += e.length;
        if (e.angle > limit) left += e.length;
      }
      EXPECT_LT(left, 0.01 * above) << scale << " " << sharp_angle;
    }
}

TEST(PartingAngle, StaysBelowACreaseOnARoughSurface) {
  const std::vector<BentEdge> rough = tail(1000, 10);
  double above = 0;
  for (const BentEdge& e : rough) above += e.angle > 40 ? e.length : 0;
  for (const double crease : {80.0, 90.0, 120.0}) {
    const double limit = parting_angle(with(rough, crease, above), 40);
    EXPECT_GE(limit, 40);
    EXPECT_LT(limit, crease) << "the crease would go";
  }
}

TEST(PartingAngle, ChamfersBelowTheSharpAngleAreNoTail) {
  // Many edges just below, but nothing below these.
  std::vector<BentEdge> part{{35, 10}, {45, 8}, {90, 5}, {1, 100}};
  EXPECT_EQ(parting_angle(part, 40), 40);
}

TEST(PartingAngle, LengthsCountNotNumbers) {
  std::vector<BentEdge> coarse = tail(1000, 15), fine;
  for (const BentEdge& e : coarse)
    for (int piece = 0; piece < 4; ++piece) fine.push_back({e.angle, e.length / 4});
  EXPECT_EQ(parting_angle(fine, 40), parting_angle(coarse, 40));
}

}  // namespace
}  // namespace hybrid_quad
