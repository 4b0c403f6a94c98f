#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/features/feature_gaps.h"
#include "hybrid_quad/features/features.h"
#include "hybrid_quad/features/narrow_facets.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

FeatureGraph detect(const TriangleMesh& m, const FeatureOptions& options = {}) {
  const FeatureGraph g = detect_features(m, options, RunContext{});
  EXPECT_EQ(violations_of(g, m), std::vector<std::string>{});
  return g;
}

int corners(const FeatureGraph& g) {
  int n = 0;
  for (const char c : g.is_corner) n += c;
  return n;
}

int regions(const FeatureGraph& g) {
  int n = 0;
  for (const int r : g.face_region) n = std::max(n, r + 1);
  return n;
}

TEST(Features, BoxHasTwelveEdgesEightCornersSixRegions) {
  for (const int n : {1, 2, 5}) {
    const FeatureGraph g = detect(test::box(n));
    EXPECT_EQ(g.curves.size(), 12u);
    EXPECT_EQ(corners(g), 8);
    EXPECT_EQ(regions(g), 6);
    for (const auto& c : g.curves) EXPECT_EQ(static_cast<int>(c.vertices.size()), n + 1);
  }
}

TEST(Features, SmoothSurfaceHasNone) {
  const FeatureGraph g = detect(test::icosphere(3));
  EXPECT_TRUE(g.curves.empty());
  EXPECT_EQ(regions(g), 1);
}

TEST(Features, CylinderHasTwoClosedBoundaryCurves) {
  const FeatureGraph g = detect(test::open_cylinder(32, 8));
  ASSERT_EQ(g.curves.size(), 2u);
  for (const auto& c : g.curves) {
    EXPECT_TRUE(c.closed);
    EXPECT_TRUE(c.boundary);
    EXPECT_EQ(c.vertices.front(), c.vertices.back());
  }
}

TEST(Features, GridBoundaryTurnsAtItsCorners) {
  const FeatureGraph g = detect(test::flat_grid(5, 4));
  EXPECT_EQ(corners(g), 4);
  EXPECT_EQ(g.curves.size(), 4u);
}

TEST(Features, SharpAngleDecides) {
  const TriangleMesh m = test::wedge(4, 120);  // normals differ by 60 degrees
  FeatureOptions options;
  options.sharp_angle = 59;
  EXPECT_EQ(regions(detect(m, options)), 2);
  options.sharp_angle = 61;
  EXPECT_EQ(regions(detect(m, options)), 1);
  options.sharp_angle = 10;
  options.use_sharp_angle = false;
  EXPECT_EQ(regions(detect(m, options)), 1);
}

TEST(Features, MarkedEdgesStayHoweverShort) {
  const TriangleMesh m = test::icosphere(3);
  FeatureOptions options;
  options.minimum_length = 100;
  const int h = 77;
  options.marked_edges = {{m.from(h), m.to(h)}};
  const FeatureGraph g = detect(m, options);
  ASSERT_EQ(g.curves.size(), 1u);
  EXPECT_TRUE(g.is_corner[m.from(h)] && g.is_corner[m.to(h)]);
  EXPECT_EQ(regions(g), 1);
  options.marked_edges = {{m.from(h), m.from(h)}};
  EXPECT_THROW(detect(m, options), InputError);
}

TEST(Features, MinimumLengthDropsShortSetsOnly) {
  FeatureOptions options;
  options.minimum_length = 6;
  EXPECT_EQ(detect(test::box(3), options).curves.size(), 12u);
  options.minimum_length = 12.1;
  EXPECT_TRUE(detect(test::box(3), options).curves.empty());
}

/// The mesh with every vertex moved by up to `size` of the mean edge length in each direction.
TriangleMesh with_noise(const TriangleMesh& mesh, double size, unsigned seed) {
  double mean = 0;
  for (int h = 0; h < mesh.halfedge_count(); ++h) mean += mesh.edge_length(h) / mesh.halfedge_count();
  std::mt19937 random(seed);
  std::vector<Vector3> p = mesh.positions();
  for (Vector3& q : p)
    for (int i = 0; i < 3; ++i) q[i] += size * mean * (2.0 * random() / 4294967295.0 - 1);
  return TriangleMesh(std::move(p), mesh.faces());
}

double length_of(const FeatureGraph& g, const TriangleMesh& m) {
  double sum = 0;
  for (int h = 0; h < m.halfedge_count(); ++h)
    if (g.is_feature(h) && !m.is_boundary(h)) sum += 0.5 * m.edge_length(h);
  return sum;
}

TEST(Features, NoiseOfAScanIsNoFeature) {
  for (const double size : {0.18, 0.2, 0.25}) {
    const TriangleMesh m = with_noise(test::icosphere(5), size, 7);
    FeatureOptions options;
    const double all = length_of(detect(m, options), m);
    EXPECT_GT(all, 1) << "the noise has no edges by angle, so this shows nothing";
    for (const double quads : {500.0, 2000.0}) {
      options.minimum_length = 3 * std::sqrt(m.total_area() / quads);
      EXPECT_EQ(detect(m, options).curves.size(), 0u) << size << ' ' << quads;
    }
  }
}

TEST(Features, NeitherIsItWhereQuadsAreAsSmallAsItsTriangles) {
  for (const double size : {0.25, 0.35}) {
    const TriangleMesh m = with_noise(test::icosphere(5), size, 7);
    FeatureOptions options;
    for (const double quads : {8000.0, 20000.0, 40000.0}) {
      options.minimum_length = 3 * std::sqrt(m.total_area() / quads);
      EXPECT_LT(length_of(detect(m, options), m), 0.01 * length_of(detect(m), m)) << size << ' ' << quads;
    }
  }
}

TEST(Features, CreasesOutliveNoise) {
  const TriangleMesh clean = test::box(30);
  for (const double size : {0.05, 0.1, 0.15}) {
    const TriangleMesh m = with_noise(clean, size, 3);
    FeatureOptions options;
    options.minimum_length = 3 * std::sqrt(m.total_area() / 600);
    const FeatureGraph creases = detect(clean), found = detect(m, options);
    double kept = 0, wrong = 0, all = 0;
    for (int h = 0; h < m.halfedge_count(); ++h) {
      all += creases.is_feature(h) * m.edge_length(h);
      (creases.is_feature(h) ? kept : wrong) += found.is_feature(h) * m.edge_length(h);
    }
    EXPECT_GT(kept, 0.99 * all) << size;
    EXPECT_LT(wrong, 0.01 * all) << size;
  }
}

TEST(Features, ASmallClearLoopStaysWhereNoiseGoes) {
  // A plate with a round step in it, fine enough that the step is two or three quads around.
  const int n = 60;
  const TriangleMesh flat = test::flat_grid(n, n, 6, 6);
  std::vector<Vector3> p = flat.positions();
  for (Vector3& q : p) {
    const Vector3 from_middle(q.x() - 3, q.y() - 3, 0);
    q.z() = from_middle.norm() < 0.7 ? 1.0 : 0.0;
  }
  const TriangleMesh step(std::move(p), flat.faces());
  FeatureOptions options;
  options.minimum_length = 3.0;
  EXPECT_GT(length_of(detect(step, options), step), 2 * 3.0);
  EXPECT_EQ(regions(detect(with_noise(step, 0.05, 5), options)), regions(detect(step, options)));
}

/// The surface that a polyline (radius, height) sweeps about the z axis, from the outside in; its last point is on the axis.
TriangleMesh turned(const std::vector<std::array<double, 2>>& profile, int sides) {
  std::vector<Vector3> p;
  std::vector<std::array<int, 3>> t;
  const int rings = static_cast<int>(profile.size()) - 1;
  for (int r = 0; r < rings; ++r)
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * 3.14159265358979323846 * i / sides;
      p.emplace_back(profile[r][0] * std::cos(angle), profile[r][0] * std::sin(angle), profile[r][1]);
    }
  p.emplace_back(0, 0, profile.back()[1]);
  for (int r = 0; r < rings; ++r)
    for (int i = 0; i < sides; ++i) {
      const int next = (i + 1) % sides, a = r * sides + i, b = r * sides + next;
      if (r + 1 == rings) {
        t.push_back({a, b, rings * sides});
        continue;
      }
      t.push_back({a, b, b + sides});
      t.push_back({a, b + sides, a + sides});
    }
  return TriangleMesh(std::move(p), std::move(t));
}

TEST(Features, RimAndBottomOfABlindHoleStayTogether) {
  // Of radius 1, in a round plate of radius 8: with short triangles along its wall, and with one from rim to bottom.
  std::vector<std::array<double, 2>> profile{{8, 0}, {4, 0}, {2, 0}, {1.5, 0}, {1, 0}};
  for (const int rows : {1, 20}) {
    std::vector<std::array<double, 2>> hole = profile;
    for (int row = 1; row <= rows; ++row) hole.push_back({1, -4.0 * row / rows});
    hole.push_back({0.5, -4.2});
    hole.push_back({0, -4.4});
    const TriangleMesh m = turned(hole, 24);
    const double around = 2 * 3.14159265358979323846;
    for (const double share : {3.0, 1.0, 0.7, 0.45}) {
      FeatureOptions options;
      options.minimum_length = around / share;
      const FeatureGraph g = detect(m, options);
      EXPECT_EQ(g.curves.size(), 3u) << "the boundary, the rim and the bottom's edge; rows " << rows << ", share " << share;
      EXPECT_EQ(g.left_out, 0);
    }
    FeatureOptions options;
    options.minimum_length = around / 0.35;
    const FeatureGraph g = detect(m, options);
    EXPECT_EQ(g.curves.size(), 1u) << rows;
    EXPECT_EQ(g.left_out, 2) << "what is lost is told";
  }
}

TEST(Features, OnlyCurvesThatGoAroundEvenlyAreRounds) {
  FeatureOptions options;
  options.minimum_length = 12 / 0.7;
  EXPECT_TRUE(detect(test::box(3), options).curves.empty()) << "these meet in threes";
  // A rim of seven sides may be a bump of a few triangles.
  const std::vector<std::array<double, 2>> bump{{8, 0}, {4, 0}, {1, 0}, {0.9, 1}, {0, 1.1}};
  options.minimum_length = 2 * 3.14159265358979323846 / 0.7;
  EXPECT_EQ(detect(turned(bump, 7), options).curves.size(), 1u);
  EXPECT_EQ(detect(turned(bump, 9), options).curves.size(), 3u);
}

TEST(Features, FoldsThatFenceInLessThanAQuadAreNone) {
  // A field of cells of length 1; quads of length 3. In its middle every other vertex is raised: each triangle there is its own facet.
  const TriangleMesh grid = test::flat_grid(30, 30, 30, 30);
  const auto raised = [&](const auto& height) {
    std::vector<Vector3> positions = grid.positions();
    for (Vector3& p : positions) p.z() = height(std::lround(p.x()), std::lround(p.y()));
    return TriangleMesh(positions, grid.faces());
  };
  FeatureOptions options;
  options.minimum_length = 9;
  const auto features_inside = [&](const TriangleMesh& m) {
    const FeatureGraph g = detect(m, options);
    int count = 0;
    for (const auto& curve : g.curves) count += !curve.boundary;
    return count;
  };
  const auto in_the_middle = [](long x, long y) { return x >= 12 && x <= 18 && y >= 12 && y <= 18; };
  EXPECT_EQ(features_inside(raised([&](long x, long y) { return in_the_middle(x, y) && (x + y) % 2 ? 0.7 : 0.0; })), 0);
  // A plateau of two quads by two.
  EXPECT_GT(features_inside(raised([&](long x, long y) { return in_the_middle(x, y) ? 2.0 : 0.0; })), 0);
}

/// A sheet with this profile in x and z, four long in y.
TriangleMesh extruded(const std::vector<std::array<double, 2>>& profile) {
  const int cells = static_cast<int>(profile.size()) - 1, rows = 2;
  const TriangleMesh grid = test::flat_grid(cells, rows, cells, 4);
  std::vector<Vector3> positions = grid.positions();
  for (Vector3& p : positions) {
    const auto& at = profile[std::lround(p.x())];
    p = {at[0], p.y(), at[1]};
  }
  return TriangleMesh(positions, grid.faces());
}

/// Lengths of the curves that are not on the boundary.
std::vector<double> inner_lengths(const TriangleMesh& m, const FeatureGraph& g) {
  std::vector<double> lengths;
  for (const auto& curve : g.curves) {
    if (curve.boundary) continue;
    lengths.push_back(0);
    for (std::size_t i = 1; i < curve.vertices.size(); ++i)
      lengths.back() += (m.position(curve.vertices[i]) - m.position(curve.vertices[i - 1])).norm();
  }
  return lengths;
}

TEST(Features, ACreaseWithSliversAlongItIsOneLine) {
  // Two plates at a right angle; where they meet, strips as long as they are, a hundredth of a quad wide, fold this way and that.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> off(-0.01, 0.01);
  for (const bool is_bent : {true, false}) {
    std::vector<std::array<double, 2>> profile{{-2, 0}, {-0.02, 0}};
    for (int i = 0; i < 9; ++i) profile.push_back({off(random), off(random)});
    if (is_bent) profile.insert(profile.end(), {{0, -0.02}, {0, -2}});
    else profile.insert(profile.end(), {{0.02, 0}, {2, 0}});
    const TriangleMesh m = extruded(profile);
    FeatureOptions options;
    EXPECT_GT(inner_lengths(m, detect(m, options)).size(), 3u);
    options.minimum_length = 3;
    const std::vector<double> lengths = inner_lengths(m, detect(m, options));
    EXPECT_EQ(lengths.size(), is_bent ? 1u : 0u);
    for (const double length : lengths) EXPECT_NEAR(length, 4, 1e-9);
  }
}

TEST(Features, ARoundOfNarrowFacetsIsNoCrease) {
  // A quarter of a cylinder of a tenth of a quad's radius in facets of 15 degrees, each narrower than what counts for nothing.
  std::vector<std::array<double, 2>> profile{{-2, 0.1}};
  for (int i = 0; i <= 6; ++i) {
    const double turn = i * 15 * 3.14159265358979323846 / 180;
    profile.push_back({0.1 * std::sin(turn), 0.1 * std::cos(turn)});
  }
  profile.push_back({0.1, -2});
  const TriangleMesh m = extruded(profile);
  FeatureOptions options;
  options.minimum_length = 3;
  EXPECT_TRUE(inner_lengths(m, detect(m, options)).empty());
}

TEST(NarrowFacets, TakeTheNormalsBesideTheirLongestBorder) {
  // A step of a fiftieth between two plates that are not quite parallel: the wall has a longer border with neither, the first counts.
  const TriangleMesh m = extruded({{-1, 0}, {0, 0}, {0, 0.02}, {1, 0.1}});
  std::vector<Vector3> normals;
  for (int f = 0; f < m.face_count(); ++f) normals.push_back(m.normal(f));
  std::vector<char> is_inner(m.halfedge_count());
  for (int h = 0; h < m.halfedge_count(); ++h) is_inner[h] = !m.is_boundary(h);
  const auto is_wall = [&](int f) { return std::abs(m.normal(f).x()) > 0.9; };
  const std::vector<Vector3> seen = normals_beside_narrow_facets(m, normals, is_inner, 0.2, 0.7, 0.05);
  const std::vector<Vector3> too_wide = normals_beside_narrow_facets(m, normals, is_inner, 0.2, 0.7, 0.01);
  for (int f = 0; f < m.face_count(); ++f) {
    EXPECT_EQ(too_wide[f], normals[f]);
    if (is_wall(f)) EXPECT_GT(seen[f].z(), 0.99);
    else EXPECT_EQ(seen[f], normals[f]);
  }
}

TEST(FeatureGaps, AreClosedByTheShortestWayUnlessTheEndsAreJoinedAnyway) {
  const int n = 10;
  const TriangleMesh m = test::flat_grid(n, n, n, n);
  const auto on_line = [&](int h, double from, double to) {
    const Vector3 a = m.position(m.from(h)), b = m.position(m.to(h));
    return std::abs(a.x() - 5) < 0.1 && std::abs(b.x() - 5) < 0.1 && std::min(a.y(), b.y()) > from - 0.1 && std::max(a.y(), b.y()) < to + 0.1;
  };
  std::vector<char> line(m.halfedge_count(), 0);
  for (int h = 0; h < m.halfedge_count(); ++h) line[h] = on_line(h, 0, 4) || on_line(h, 6, 10);
  EXPECT_TRUE(ways_over_gaps(m, line, 1.9, RunContext{}).empty());
  const std::vector<int> way = ways_over_gaps(m, line, 2.1, RunContext{});
  EXPECT_EQ(way.size(), 2u);
  for (const int h : way) EXPECT_TRUE(on_line(h, 4, 6));
  // One end goes on to the boundary, as far as the other is joined to it already.
  for (int h = 0; h < m.halfedge_count(); ++h) line[h] = on_line(h, 0, 1);
  EXPECT_TRUE(ways_over_gaps(m, line, 1.1, RunContext{}).empty());
}

TEST(Features, AZigzagIsNoCornerSeenFromFarther) {
  const int n = 20;
  const TriangleMesh m = test::flat_grid(n, n, n, n);
  // Along y = 10 to the middle, one cell up, and on: a jog. Then a corner: along x = 10 down from there.
  const auto chain = [&](const std::vector<Vector3>& points) {
    std::vector<char> is_feature(m.halfedge_count(), 0);
    for (std::size_t i = 1; i < points.size(); ++i)
      for (int h = 0; h < m.halfedge_count(); ++h) {
        const Vector3 along = points[i] - points[i - 1];
        const auto lies_on = [&](int v) {
          const double t = (m.position(v) - points[i - 1]).dot(along) / along.squaredNorm();
          return t > -1e-9 && t < 1 + 1e-9 && (m.position(v) - points[i - 1] - t * along).norm() < 1e-9;
        };
        if (lies_on(m.from(h)) && lies_on(m.to(h))) is_feature[h] = 1;
      }
    return is_feature;
  };
  const auto inner_corners = [&](const std::vector<Vector3>& points, double reach) {
    CornerRule rule;
    rule.reach = reach;
    const FeatureGraph g = trace_features(m, chain(points), rule);
    int count = 0;
    for (int v = 0; v < m.vertex_count(); ++v) count += g.is_corner[v] && !m.is_boundary_vertex(v);
    return count;
  };
  const std::vector<Vector3> jog{{0, 10, 0}, {10, 10, 0}, {10, 11, 0}, {20, 11, 0}}, corner{{0, 10, 0}, {10, 10, 0}, {10, 0, 0}};
  EXPECT_EQ(inner_corners(jog, 0), 2);
  EXPECT_EQ(inner_corners(jog, 4), 0);
  EXPECT_EQ(inner_corners(corner, 0), 1);
  EXPECT_EQ(inner_corners(corner, 4), 1);
}

TEST(Features, WeakEdgesBridgeAGapBetweenStrongOnes) {
  // A wedge whose fold is soft in the middle: 60 degrees at both ends, 30 degrees at half its length.
  const int n = 16;
  const TriangleMesh flat = test::flat_grid(2, n, 2, 8);
  std::vector<Vector3> p = flat.positions();
  for (Vector3& q : p) {
    const double soft = std::exp(-std::pow((q.y() - 4) / 1.0, 2));
    const double slope = std::tan((30 - 13 * soft) * 3.14159265358979 / 180);
    q.z() = -slope * std::abs(q.x() - 1);
  }
  const TriangleMesh m(std::move(p), flat.faces());
  FeatureOptions options;
  EXPECT_EQ(regions(detect(m, options)), 2);
  options.weak_angle = 39;
  EXPECT_EQ(regions(detect(m, options)), 1);
}

}  // namespace
}  // namespace hybrid_quad
