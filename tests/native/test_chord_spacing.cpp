#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hybrid_quad/improve/chord_spacing.h"

namespace hybrid_quad {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// An arc of a circle of radius 1, as a polyline.
CurveGeometry arc_of_circle(double angle, int segments) {
  std::vector<Vector3> points;
  for (int i = 0; i <= segments; ++i) points.emplace_back(std::cos(angle * i / segments), std::sin(angle * i / segments), 0);
  if (angle >= 2 * kPi) points.back() = points.front();
  return CurveGeometry(std::move(points), angle >= 2 * kPi);
}

/// As much room as vertices can have without meeting.
CurveSpacing with_room(const CurveGeometry& curve, std::vector<double> arc, double share) {
  CurveSpacing spacing{std::move(arc), {}};
  const int n = static_cast<int>(spacing.arc.size());
  for (int i = 0; i < n; ++i) {
    const double before = spacing.arc[i] - (i > 0 ? spacing.arc[i - 1] : spacing.arc[n - 1] - curve.length());
    const double after = (i + 1 < n ? spacing.arc[i + 1] : spacing.arc[0] + curve.length()) - spacing.arc[i];
    spacing.room.push_back(share * std::min(before, after));
  }
  return spacing;
}

TEST(ChordDeviation, IsTheSagittaOfAnArc) {
  const CurveGeometry curve = arc_of_circle(3, 3000);
  EXPECT_NEAR(chord_deviation(curve, 0.2, 1.2), 1 - std::cos(0.5), 1e-4);
  const CurveGeometry ring = arc_of_circle(2 * kPi, 6000);
  EXPECT_NEAR(chord_deviation(ring, 2 * kPi - 0.3, 2 * kPi + 0.7), 1 - std::cos(0.5), 1e-4) << "across the seam";
}

TEST(SpacedByChords, EvenAlongACircle) {
  const CurveGeometry curve = arc_of_circle(2, 2000);
  constexpr int kEdges = 10;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  std::vector<double> arc;
  for (int i = 0; i <= kEdges; ++i) arc.push_back(curve.length() * (i + (i > 0 && i < kEdges ? shift(random) : 0)) / kEdges);
  const double before = largest_chord_deviation(curve, arc), even = chord_deviation(curve, 0, curve.length() / kEdges);
  const double after = largest_chord_deviation(curve, spaced_by_chords(curve, with_room(curve, arc, 0.45)));
  EXPECT_GT(before, 1.3 * even);
  EXPECT_LT(after, even + 0.3 * (before - even));
}

TEST(SpacedByChords, GainsOnCoarseRings) {
  // Edges as long as each other cut the corners of a polygon that has another number of them.
  const CurveGeometry ring = arc_of_circle(2 * kPi, 17);
  std::vector<double> arc;
  for (int i = 0; i < 12; ++i) arc.push_back(ring.length() * i / 12);
  const CurveSpacing spacing = with_room(ring, arc, 0.3);
  const std::vector<double> spaced = spaced_by_chords(ring, spacing);
  EXPECT_LT(largest_chord_deviation(ring, spaced), 0.93 * largest_chord_deviation(ring, arc));
  for (std::size_t i = 0; i < arc.size(); ++i) {
    const double moved = std::remainder(spaced[i] - arc[i], ring.length());
    EXPECT_LE(std::abs(moved), spacing.room[i] * (1 + 1e-9));
  }
}

TEST(SpacedByChords, NeverFartherAndInOrderWithinTheRoom) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<Vector3> points = {Vector3::Zero()};
    for (int i = 0; i < 30; ++i) points.push_back(points.back() + Vector3(unit(random), unit(random) - 0.5, unit(random) - 0.5));
    const CurveGeometry curve(points, false);
    std::vector<double> arc = {0};
    for (int i = 0; i < 8; ++i) arc.push_back(arc.back() + 0.2 + unit(random));
    for (double& s : arc) s *= curve.length() / arc.back();
    CurveSpacing spacing = with_room(curve, arc, 0.3);
    const std::vector<double> spaced = spaced_by_chords(curve, spacing);
    EXPECT_LE(largest_chord_deviation(curve, spaced), largest_chord_deviation(curve, arc) * (1 + 1e-9));
    EXPECT_EQ(spaced.front(), arc.front());
    EXPECT_EQ(spaced.back(), arc.back());
    for (std::size_t i = 1; i < arc.size(); ++i) {
      EXPECT_GT(spaced[i], spaced[i - 1]);
      EXPECT_LE(std::abs(spaced[i] - arc[i]), spacing.room[i] * (1 + 1e-9));
    }
  }
}

TEST(SpacedByChords, LeavesStraightLinesAlone) {
  const CurveGeometry curve({Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(3, 0, 0)}, false);
  const std::vector<double> arc = {0, 0.5, 2.2, 3};
  EXPECT_EQ(spaced_by_chords(curve, with_room(curve, arc, 0.3)), arc);
}

}  // namespace
}  // namespace hybrid_quad
