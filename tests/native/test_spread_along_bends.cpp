#include "hybrid_quad/improve/spread_along_bends.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hybrid_quad/improve/chord_spacing.h"
#include "hybrid_quad/improve/smoothing_options.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

constexpr int kAround = 16, kAlong = 5;
constexpr double kPi = 3.14159265358979323846, kHeight = 2;

/// A tube of even quads but for their vertices on both rims, which are shifted by up to some share of an edge.
struct Tube {
  explicit Tube(double most_shifted) : input(test::open_cylinder(24 * kAround, 60, 1, kHeight)), features(detect_features(input, FeatureOptions{}, RunContext{})), index(input, features.face_region) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-most_shifted, most_shifted);
    for (int j = 0; j <= kAlong; ++j)
      for (int i = 0; i < kAround; ++i) {
        const bool is_rim = j == 0 || j == kAlong;
        const double angle = 2 * kPi * (i + (is_rim ? shift(random) : 0)) / kAround;
        quads.positions.emplace_back(std::cos(angle), std::sin(angle), bottom() + kHeight * j / kAlong);
        quads.kind.push_back(is_rim ? VertexKind::kCurve : VertexKind::kFree);
        quads.anchor.push_back(is_rim ? rim(j) : features.face_region[0]);
        quads.near_face.push_back(-1);
      }
    for (int j = 0; j < kAlong; ++j)
      for (int i = 0; i < kAround; ++i) quads.quads.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
    for (const int j : {0, kAlong})
      for (int i = 0; i < kAround; ++i) {
        if (runs_backwards(rim(j))) quads.feature_edges.push_back({id(i + 1, j), id(i, j), rim(j)});
        else quads.feature_edges.push_back({id(i, j), id(i + 1, j), rim(j)});
      }
  }

  static int id(int i, int j) { return kAround * j + i % kAround; }
  double bottom() const { return input.positions()[0].z(); }
  const Vector3& on_curve(int curve, int i) const { return input.position(features.curves[curve].vertices[i]); }
  int rim(int j) const { return (on_curve(0, 0).z() > bottom() + 0.5 * kHeight) == (j > 0) ? 0 : 1; }
  bool runs_backwards(int curve) const { return on_curve(curve, 0).cross(on_curve(curve, 1)).z() < 0; }

  TriangleMesh input;
  FeatureGraph features;
  SurfaceIndex index;
  QuadMesh quads;
};

struct Spread {
  explicit Spread(const Tube& tube) : piece(tube.quads, tube.input, tube.features, tube.index), smoother(bound(piece), smoothing_of(ImproveOptions{}, 1)) {
    smoother.update_frames(true);
    before = deviation(tube);
    std::vector<double> shapes;
    for (int q = 0; q < piece.mesh.quad_count(); ++q) shapes.push_back(smoother.signed_quality(q));
    chains = spread_along_bends(piece, smoother, RunContext{});
    after = deviation(tube);
    for (int q = 0; q < piece.mesh.quad_count(); ++q) {
      lost += (shapes[q] - smoother.signed_quality(q)) / piece.mesh.quad_count();
      worst = std::min(worst, smoother.signed_quality(q));
    }
  }

  static Workpiece& bound(Workpiece& piece) {
    piece.bind_all();
    return piece;
  }

  double deviation(const Tube& tube) const {
    double largest = 0;
    for (const QuadMesh::FeatureEdge& e : tube.quads.feature_edges) {
      const CurveGeometry& curve = piece.curves[e.curve];
      const double from = piece.arc[e.a], to = piece.arc[e.b];
      largest = std::max(largest, chord_deviation(curve, from, to > from ? to : to + curve.length()));
    }
    return largest;
  }

  Workpiece piece;
  Smoother smoother;
  int chains = 0;
  double before = 0, after = 0, lost = 0, worst = 1;
};

TEST(SpreadAlongBends, UnevenRimsComeNearTheBestThereIs) {
  const Tube tube(0.12);
  ASSERT_EQ(tube.features.curves.size(), 2u);
  const double best = 1 - std::cos(kPi / kAround);
  const Spread spread(tube);
  EXPECT_GT(spread.before, 1.25 * best);
  EXPECT_GT(spread.chains, 2) << "a rim is spread more than once";
  // One round takes three quarters of what can be gained.
  EXPECT_LT(spread.after, best + 0.1 * (spread.before - best));
}

TEST(SpreadAlongBends, QuadsLoseNoMoreThanTheyBear) {
  for (const double shift : {0.05, 0.12, 0.25}) {
    const Spread spread((Tube(shift)));
    EXPECT_LE(spread.after, spread.before);
    EXPECT_LE(spread.lost, 0.012);
    EXPECT_GT(spread.worst, 0.5);
  }
}

TEST(SpreadAlongBends, EvenRimsStay) {
  const Spread spread((Tube(0)));
  EXPECT_EQ(spread.chains, 0);
  EXPECT_EQ(spread.after, spread.before);
}

}  // namespace
}  // namespace hybrid_quad
