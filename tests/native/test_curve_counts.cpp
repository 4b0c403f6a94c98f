// An exact number of quad edges along curves: dealt out to curves, kept by the lift and the extraction, and end to end.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/features/curve_counts.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/regular_quads/curve_coordinates.h"
#include "hybrid_quad/spanning_parameterization/curve_counts.h"
#include "hybrid_quad/spanning_parameterization/movable_grid.h"
#include "hybrid_quad/spanning_parameterization/dislocations.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

/// Vertices of a mesh for which `is_on` holds, sorted by `place`.
template <class IsOn, class Place>
std::vector<int> path_of(const TriangleMesh& mesh, IsOn is_on, Place place) {
  std::vector<int> path;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (is_on(mesh.position(v))) path.push_back(v);
  std::sort(path.begin(), path.end(), [&](int a, int b) { return place(mesh.position(a)) < place(mesh.position(b)); });
  return path;
}

bool is_zero(double x) { return std::abs(x) < 1e-9; }

/// The box's edge along an axis through the origin.
std::vector<int> box_edge(const TriangleMesh& box, int axis) {
  return path_of(box, [=](const Vector3& p) { return is_zero(p[(axis + 1) % 3]) && is_zero(p[(axis + 2) % 3]); },
                 [=](const Vector3& p) { return p[axis]; });
}

std::vector<std::array<int, 2>> edges_of(const std::vector<int>& path) {
  std::vector<std::array<int, 2>> edges;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) edges.push_back({path[i], path[i + 1]});
  return edges;
}

/// Edges of the result (each once) with both ends on a set of points.
template <class IsOn>
int edges_on(const QuadMesh& mesh, IsOn is_on) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& q : mesh.quads)
    for (int i = 0; i < 4; ++i) {
      const int a = q[i], b = q[(i + 1) & 3];
      if (is_on(mesh.positions[a]) && is_on(mesh.positions[b])) edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  return static_cast<int>(std::unique(edges.begin(), edges.end()) - edges.begin());
}

RemeshResult remeshed(const TriangleMesh& mesh, int quads, std::vector<CurveCount> counts, double sharp_angle = 40) {
  RemeshOptions options;
  options.quads = quads;
  options.use_sharp_angle = sharp_angle < 180;
  options.sharp_angle = sharp_angle;
  options.curve_counts = std::move(counts);
  RemeshResult result = remesh(test::soup_of(mesh), options, RunContext{});
  const auto found = violations_of(result.mesh);
  EXPECT_TRUE(found.empty()) << found.front();
  return result;
}

FeatureGraph box_features(const TriangleMesh& mesh) { return detect_features(mesh, FeatureOptions{}, RunContext{}); }

TEST(CurveCounts, AreDealtOutByLengthWhereCornersLieOnAChain) {
  const TriangleMesh mesh = test::box(6, {2, 1, 1});
  FeatureGraph features = box_features(mesh);
  std::vector<int> path = box_edge(mesh, 1);
  std::reverse(path.begin(), path.end());
  const std::vector<int> rest = box_edge(mesh, 0);
  path.insert(path.end(), rest.begin() + 1, rest.end());
  const CountedChain chain{edges_of(path), 13};
  EXPECT_EQ(chain_ends(chain).size(), 2u);
  const PlannedChain plan = plan_curve_counts(mesh, {chain}, features).front();
  ASSERT_EQ(plan.curves.size(), 2u);
  EXPECT_EQ(plan.count, 13);
  for (const int c : plan.curves) {
    const FeatureCurve& curve = features.curves[c];
    const double length = (mesh.position(curve.vertices.front()) - mesh.position(curve.vertices.back())).norm();
    EXPECT_NEAR(curve.asked_count, 13 * length / 3, 0.5 + 1e-9);
  }
}

TEST(CurveCounts, ALoopGetsTheNearestEvenNumber) {
  const TriangleMesh mesh = test::flat_grid(8, 8);
  FeatureGraph features = box_features(mesh);
  CountedChain border;
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.is_boundary(h)) border.edges.push_back({mesh.from(h), mesh.to(h)});
  EXPECT_TRUE(chain_ends(border).empty());
  for (const int asked : {2, 5, 15, 16}) {
    border.count = asked;
    const PlannedChain plan = plan_curve_counts(mesh, {border}, features).front();
    EXPECT_EQ(plan.count % 2, 0);
    EXPECT_GE(plan.count, 4);
    EXPECT_LE(std::abs(plan.count - std::max(asked, 4)), asked % 2);
    EXPECT_EQ(plan.obstacle == CountObstacle::kNone, asked == 16) << asked;
    for (const FeatureCurve& curve : features.curves) EXPECT_GE(curve.asked_count, 1);
  }
}

/// All edges of a box with counts of any parity that fits its corners' signs.
WorkingSurface counted_box(int seed) {
  WorkingSurface surface = test::surface_of(test::box(16), 1.0 / 6);
  for (std::size_t c = 0; c < surface.features.curves.size(); ++c) {
    FeatureCurve& curve = surface.features.curves[c];
    const int odd = (curve.vertices.front() * 7 + curve.vertices.back() * 7) & 1;
    curve.asked_count = 4 + 2 * ((static_cast<int>(c) * 5 + seed) % 3) + odd;
  }
  return surface;
}

TEST(CurveCounts, DislocationsLeaveCurvesMostOfTheirEdges) {
  const WorkingSurface surface = test::surface_of(test::box(16), 1.0 / 6);
  const FrameField frames = test::smooth_frames(surface, 1.0 / 6);
  const GridMeasure measure = measure_edges(surface, frames);
  LiftedGrid grid = lift(surface, frames, solve_periodic_field(surface, frames, PeriodicFieldOptions{}, RunContext{}), measure);
  MovableGrid movable(surface, frames, measure, 1, grid);
  // A row goes to and fro across an edge of the box until it may not: none of it is lost before less than two thirds are left.
  for (int h = 0; h < surface.mesh.halfedge_count(); ++h) {
    const int axis = measure.axis[h];
    if (axis < 0) continue;
    const int curve = surface.features.halfedge_curve[h], before = grid.curve_count[curve];
    IntVector2 shorter{0, 0};
    shorter[axis] = along_sign(measure, h);
    int taken = 0;
    for (; taken < before && movable.may_cross(h, shorter); ++taken) movable.cross(h, shorter);
    EXPECT_LE(before - taken, 5);
    EXPECT_GE(before - taken, 4);
    for (; taken > 0; --taken) movable.cross(h, minus(shorter));
    EXPECT_EQ(grid.curve_count[curve], before);
  }
}

TEST(CurveCounts, BentCurvesKeepWhatTheirBendsTake) {
  // Eight edges around the rim of a tube: seven tenths of them, five, would be a quarter of an edge from it.
  constexpr double kPi = 3.14159265358979323846;
  const double h = 2 * kPi / 8;
  const WorkingSurface surface = test::surface_of(test::open_cylinder(48, 16), h);
  const GridMeasure measure = measure_edges(surface, test::smooth_frames(surface, h));
  const std::vector<CountRange> ranges = allowed_counts(surface, measure);
  ASSERT_EQ(ranges.size(), 2u);
  for (const CountRange& range : ranges) {
    EXPECT_GE(range.fewest, 6);
    EXPECT_LE(range.fewest, 8);
  }
}

TEST(CurveCounts, AreTheLiftsAndStayWhileDislocationsMove) {
  for (int seed = 0; seed < 3; ++seed) {
    const WorkingSurface surface = counted_box(seed);
    const FrameField frames = test::smooth_frames(surface, 1.0 / 6);
    const PeriodicField field = solve_periodic_field(surface, frames, PeriodicFieldOptions{}, RunContext{});
    const GridMeasure measure = measure_edges(surface, frames);
    LiftedGrid grid = lift(surface, frames, field, measure);
    const auto check = [&] {
      std::vector<double> along(surface.features.curves.size(), 0);
      for (int h = 0; h < surface.mesh.halfedge_count(); ++h)
        if (measure.axis[h] >= 0 && h > surface.mesh.opposite(h))
          along[surface.features.halfedge_curve[h]] +=
              along_sign(measure, h) * grid.across_half_edge(surface.mesh, h)[measure.axis[h]];
      for (std::size_t c = 0; c < along.size(); ++c) {
        EXPECT_NEAR(along[c], surface.features.curves[c].asked_count, 1e-6);
        EXPECT_EQ(grid.curve_count[c], surface.features.curves[c].asked_count);
      }
    };
    check();
    cancel_dislocations(surface, frames, measure, SpanningOptions{}, RunContext{}, grid);
    check();
  }
}

TEST(CurveCounts, SurviveAFoldedParameterization) {
  WorkingSurface surface = test::surface_of(test::box(16), 1.0 / 6);
  const FrameField frames = test::smooth_frames(surface, 1.0 / 6);
  const PeriodicField field = solve_periodic_field(surface, frames, PeriodicFieldOptions{}, RunContext{});
  const SpanningParameterization param =
      build_spanning_parameterization(surface, frames, field, SpanningOptions{}, RunContext{});
  const CurveCoordinates natural = build_curve_coordinates(surface, frames, param);
  const auto count = [](const CurveCoordinates::Curve& c) { return static_cast<int>((c.position.back() - c.position.front()) / kGridUnit); };
  for (std::size_t c = 0; c < surface.features.curves.size(); ++c)
    surface.features.curves[c].asked_count = count(natural.curves[c]) + (c % 2 ? 4 : 1);
  const CurveCoordinates altered = build_curve_coordinates(surface, frames, param);
  for (std::size_t c = 0; c < surface.features.curves.size(); ++c) {
    // Where the corners' parity allows no other number, the curve keeps its own.
    EXPECT_EQ(count(altered.curves[c]), count(natural.curves[c]) + (c % 2 ? 4 : 0));
    EXPECT_TRUE(std::is_sorted(altered.curves[c].position.begin(), altered.curves[c].position.end()));
  }
}

TEST(CurveCounts, TwoEdgesOfABoxThatMeetInACorner) {
  const TriangleMesh box = test::box(8);
  for (const int quads : {300, 1500})
    for (const auto& [x, y] : {std::pair{6, 11}, {13, 4}, {9, 9}}) {
      const RemeshResult result = remeshed(box, quads, {{box_edge(box, 0), x}, {box_edge(box, 1), y}});
      EXPECT_EQ(edges_on(result.mesh, [](const Vector3& p) { return is_zero(p[1]) && is_zero(p[2]); }), x);
      EXPECT_EQ(edges_on(result.mesh, [](const Vector3& p) { return is_zero(p[0]) && is_zero(p[2]); }), y);
      ASSERT_EQ(result.report.curve_counts.size(), 2u);
      EXPECT_EQ(result.report.curve_counts[0].got, x);
      EXPECT_EQ(result.report.curve_counts[1].got, y);
      EXPECT_TRUE(result.report.curve_counts[0].reason.empty());
    }
}

TEST(CurveCounts, ALineInsideASmoothSurface) {
  const TriangleMesh torus = test::torus(48, 24);
  const auto is_on = [](const Vector3& p) { return is_zero(p.z()) && p.head<2>().norm() > 1; };
  std::vector<int> loop = path_of(torus, is_on, [](const Vector3& p) { return std::atan2(p.y(), p.x()); });
  loop.push_back(loop.front());
  const std::vector<int> half(loop.begin(), loop.begin() + loop.size() / 2);
  for (const int asked : {12, 31, 60}) {
    const RemeshResult open = remeshed(torus, 900, {{half, asked}}, 180);
    EXPECT_EQ(open.report.curve_counts.front().got, asked);
    EXPECT_EQ(open.mesh.feature_edges.size(), static_cast<std::size_t>(asked));
    for (const int end : {half.front(), half.back()})  // pinned
      EXPECT_TRUE(std::any_of(open.mesh.positions.begin(), open.mesh.positions.end(),
                              [&](const Vector3& p) { return (p - torus.position(end)).norm() < 1e-9; }));
    const RemeshResult closed = remeshed(torus, 900, {{loop, asked}}, 180);
    const CurveCountRecord& record = closed.report.curve_counts.front();
    EXPECT_EQ(closed.mesh.feature_edges.size(), static_cast<std::size_t>(record.got));
    EXPECT_EQ(std::abs(record.got - asked), asked % 2);
    EXPECT_EQ(record.reason.empty(), asked % 2 == 0);
    EXPECT_EQ(closed.report.warnings.empty(), asked % 2 == 0);
  }
}

TEST(CurveCounts, OddBorderOfADiskIsReported) {
  const TriangleMesh disk = test::flat_grid(12, 12);
  std::vector<int> loop;
  for (int h = disk.outgoing(0); loop.empty() || disk.from(h) != loop.front(); h = disk.outgoing(disk.to(h))) loop.push_back(disk.from(h));
  loop.push_back(loop.front());
  const RemeshResult result = remeshed(disk, 200, {{loop, 41}});
  const CurveCountRecord& record = result.report.curve_counts.front();
  EXPECT_EQ(record.asked, 41);
  EXPECT_EQ(std::abs(record.got - 41), 1);
  EXPECT_NE(record.reason.find("even"), std::string::npos);
  ASSERT_FALSE(result.report.warnings.empty());
  int border = 0;
  for (const auto& e : result.mesh.feature_edges) border += e.curve >= 0;
  EXPECT_EQ(border, record.got);
}

TEST(CurveCounts, AMirrorPlaneHalvesWhatItCuts) {
  const TriangleMesh box = test::box(8, {1, 1, 1});
  std::vector<Vector3> moved = box.positions();
  for (Vector3& p : moved) p.x() -= 0.5;
  const TriangleMesh centred(moved, box.faces());
  const std::vector<int> path = path_of(centred, [](const Vector3& p) { return is_zero(p[1]) && is_zero(p[2]); },
                                        [](const Vector3& p) { return p.x(); });
  for (const int asked : {10, 11}) {
    RemeshOptions options;
    options.quads = 600;
    options.symmetry.planes = plane(0);
    options.curve_counts = {{path, asked}};
    const RemeshResult result = remesh(test::soup_of(centred), options, RunContext{});
    const CurveCountRecord& record = result.report.curve_counts.front();
    EXPECT_EQ(edges_on(result.mesh, [](const Vector3& p) { return is_zero(p[1]) && is_zero(p[2]); }), record.got);
    EXPECT_EQ(std::abs(record.got - asked), asked % 2);
    EXPECT_EQ(record.reason.empty(), asked % 2 == 0);
  }
}

TEST(CurveCounts, NonsenseIsRefused) {
  const TriangleMesh box = test::box(4);
  const std::vector<int> path = box_edge(box, 0);
  const auto code = [&](std::vector<CurveCount> counts) -> std::string {
    try {
      remeshed(box, 100, std::move(counts));
    } catch (const InputError& error) {
      return error.code;
    }
    return "";
  };
  EXPECT_EQ(code({{path, 0}}), "curve_count_too_small");
  EXPECT_EQ(code({{{path[0]}, 4}}), "curve_not_simple");
  EXPECT_EQ(code({{{path[0], path[1], path[0]}, 4}}), "curve_not_simple");
  EXPECT_EQ(code({{{path.front(), path.back()}, 4}}), "unknown_edge");
  EXPECT_EQ(code({{{-1, path[0]}, 4}}), "index_out_of_range");
  EXPECT_EQ(code({{path, 4}, {{path[1], path[2]}, 2}}), "overlapping_curves");
}

}  // namespace
}  // namespace hybrid_quad
