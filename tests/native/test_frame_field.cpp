#include "hybrid_quad/frame_field/frame_field.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "hybrid_quad/frame_field/acute_tips.h"
#include "hybrid_quad/frame_field/cross_relaxation.h"
#include "hybrid_quad/frame_field/frame_topology.h"
#include "hybrid_quad/frame_field/smooth_connection.h"
#include "hybrid_quad/frame_field/smoothest_crosses.h"
#include "hybrid_quad/frame_field/move_cones.h"
#include "hybrid_quad/grid_algebra/quarter_turn.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

using test::surface_of;

FrameField solved(const WorkingSurface& surface) { return solve_frame_field(surface, FrameFieldOptions{}, RunContext{}); }

int index_sum(const FrameField& field) {
  int sum = 0;
  for (const auto index : field.cone_index) sum += index;
  return sum;
}

double largest_turn(const WorkingSurface& surface, const FrameField& field) {
  const FaceAngles angles(surface.mesh);
  const auto directions = frame_directions(surface.mesh, field.du, field.dv);
  double largest = 0;
  for (int h = 0; h < surface.mesh.halfedge_count(); ++h)
    if (!surface.mesh.is_boundary(h))
      largest = std::max(largest, std::abs(turn_across(surface.mesh, angles, directions, h).angle));
  return largest;
}

TriangleMesh moved(const TriangleMesh& mesh, const Eigen::Matrix3d& map) {
  std::vector<Vector3> positions = mesh.positions();
  for (Vector3& p : positions) p = map * p;
  return {positions, mesh.faces()};
}

TEST(FrameField, FlatGridIsConstantAndAlignedWithItsBorder) {
  const WorkingSurface surface = surface_of(test::flat_grid(12, 9, 4, 3), 0.5, 40);
  const FrameField field = solved(surface);
  EXPECT_TRUE(violations_of(field, surface).empty());
  EXPECT_EQ(field.cone_count(), 0);
  EXPECT_LT(largest_turn(surface, field), 1e-6);
  for (int f = 0; f < surface.mesh.face_count(); ++f)
    EXPECT_LT(std::min(std::abs(field.du[f].x()), std::abs(field.du[f].y())), 1e-6);
}

TEST(FrameField, FramesAreOrthonormal) {
  const WorkingSurface surface = surface_of(test::torus(30, 14), 0.2, 200);
  const FrameField field = solved(surface);
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    EXPECT_NEAR(field.du[f].norm(), 1, 1e-12);
    EXPECT_NEAR(field.dv[f].norm(), 1, 1e-12);
    EXPECT_NEAR(field.du[f].cross(field.dv[f]).dot(surface.mesh.normal(f)), 1, 1e-12);
  }
}

TEST(FrameField, IndicesOfASphereSumToEightQuarters) {
  const WorkingSurface surface = surface_of(test::icosphere(4), 0.2, 200);
  const FrameField field = solved(surface);
  EXPECT_TRUE(violations_of(field, surface).empty());
  EXPECT_EQ(index_sum(field), 8);
  EXPECT_EQ(field.cone_count(), 8);
}

TEST(FrameField, IndicesOfATorusSumToZero) {
  const WorkingSurface surface = surface_of(test::torus(40, 20), 0.2, 200);
  const FrameField field = solved(surface);
  EXPECT_TRUE(violations_of(field, surface).empty());
  EXPECT_EQ(index_sum(field), 0);
  EXPECT_LE(field.cone_count(), 16);  // what its curvature, four turns' worth of each sign, could ask for
}

TEST(FrameField, CubeHasItsConesAtTheCornersWhateverItsFeatures) {
  const TriangleMesh cube = test::box(6);
  const WorkingSurface smooth = surface_of(cube, 0.3, 200);
  const FrameField field = solved(smooth);
  EXPECT_TRUE(violations_of(field, smooth).empty());
  EXPECT_EQ(index_sum(field), 8);
  EXPECT_EQ(field.cone_count(), 8);

  const WorkingSurface sharp = surface_of(cube, 0.3, 40);
  const FrameField aligned = solved(sharp);
  EXPECT_TRUE(violations_of(aligned, sharp).empty());
  EXPECT_EQ(aligned.cone_count(), 0);  // the corners are features: no cones of the field
  const auto quarters =
      vertex_quarters(cube, FaceAngles(cube), frame_directions(cube, aligned.du, aligned.dv));
  int corners = 0;
  for (int v = 0; v < cube.vertex_count(); ++v) {
    corners += sharp.features.is_corner[v] != 0;
    EXPECT_EQ(quarters[v], sharp.features.is_corner[v] ? 1 : 0);
  }
  EXPECT_EQ(corners, 8);
}

TEST(FrameField, DiskHasFourQuartersAndFollowsItsBorder) {
  // A cap of the sphere: its border has no corners, so all four quarters are cones inside.
  TriangleMesh sphere = test::icosphere(4);
  std::vector<std::array<int, 3>> faces;
  for (const auto& t : sphere.faces())
    if (sphere.position(t[0]).z() > 0.2 || sphere.position(t[1]).z() > 0.2 || sphere.position(t[2]).z() > 0.2) faces.push_back(t);
  const WorkingSurface surface = surface_of(TriangleMesh(sphere.positions(), faces), 0.2, 200);
  const FrameField field = solved(surface);
  EXPECT_TRUE(violations_of(field, surface).empty());
  for (int h = 0; h < surface.mesh.halfedge_count(); ++h) {
    const int f = h / 3;
    int border = 0;
    for (int i = 0; i < 3; ++i) border += surface.mesh.is_boundary(3 * f + i);
    if (!surface.mesh.is_boundary(h) || border > 1) continue;
    const Vector2 d = field.grid_vector(surface.mesh, h);
    EXPECT_LT(std::min(std::abs(d[0]), std::abs(d[1])), 1e-6 * d.norm());
  }
}

TEST(FrameField, MotionAndScaleDoNotChangeIt) {
  const TriangleMesh mesh = moved(test::icosphere(3), Vector3(1, 0.6, 0.4).asDiagonal());
  const FrameField reference = solved(surface_of(mesh, 0.2, 200));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  for (const double scale : {1.0, 1e-30, 1e6}) {
    const WorkingSurface surface = surface_of(moved(mesh, scale * turn), 0.2 * scale, 200);
    const FrameField field = solved(surface);
    EXPECT_TRUE(violations_of(field, surface).empty()) << scale;
    EXPECT_EQ(field.cone_count(), reference.cone_count()) << scale;
  }
}

TEST(FrameField, MatchingsAndConesOfTurnedRowsAreTheSame) {
  const WorkingSurface surface = surface_of(test::icosphere(3), 0.3, 200);
  const FrameField field = solved(surface);
  std::vector<Vector3> du = field.du, dv = field.dv;
  for (int f = 0; f < surface.mesh.face_count(); ++f)
    for (int k = 0; k < (f * 7) % 4; ++k) {
      const Vector3 u = du[f];
      du[f] = dv[f];
      dv[f] = -u;
    }
  const FrameField again = frame_field_from_rows(surface, FaceAngles(surface.mesh), du, dv);
  EXPECT_TRUE(violations_of(again, surface).empty());
  EXPECT_EQ(again.cone_index, field.cone_index);
  for (int h = 0; h < surface.mesh.halfedge_count(); ++h) {
    const int o = surface.mesh.opposite(h);
    const Vector2 here = turned(again.grid_vector(surface.mesh, h), again.matching[h]);
    EXPECT_LT((here + again.grid_vector(surface.mesh, o)).norm(), here.norm());  // the best of four turns
  }
}

TEST(FrameField, NeedlesAndFacesWithoutAreaDoNoHarm) {
  for (const double scale : {1.0, 1e-30}) {
    const WorkingSurface needles = surface_of(test::capped_cylinder(200, 4, scale, scale), 0.2 * scale, 40);
    EXPECT_TRUE(violations_of(solved(needles), needles).empty());
  }
  TriangleMesh sphere = test::icosphere(3);
  std::vector<Vector3> positions = sphere.positions();
  positions[sphere.to(0)] = positions[sphere.from(0)];
  const WorkingSurface collapsed = surface_of(TriangleMesh(positions, sphere.faces()), 0.3, 200);
  const FrameField field = solved(collapsed);
  EXPECT_EQ(index_sum(field), 8);
  for (int f = 0; f < collapsed.mesh.face_count(); ++f) EXPECT_TRUE(field.du[f].allFinite() && field.dv[f].allFinite());
}

/// Every vertex moved along the normal by up to so much, each by another part.
TriangleMesh roughened(const TriangleMesh& mesh, double by) {
  std::vector<Vector3> normal(mesh.vertex_count(), Vector3::Zero()), positions = mesh.positions();
  for (int h = 0; h < mesh.halfedge_count(); ++h) normal[mesh.from(h)] += mesh.area_normal(h / 3);
  for (int v = 0; v < mesh.vertex_count(); ++v) positions[v] += by * std::sin(37.0 * v) * normal[v].normalized();
  return {positions, mesh.faces()};
}

TEST(FrameField, DetailBelowAQuadMakesNoCones) {
  // Triangles of .07, quads of .3, and angles at the vertices that miss a full turn by up to 100 degrees.
  const WorkingSurface rough = surface_of(roughened(test::icosphere(4), 0.05), 0.3, 200);
  const FrameField field = solved(rough);
  EXPECT_TRUE(violations_of(field, rough).empty());
  EXPECT_EQ(field.cone_count(), 8);
  FrameFieldOptions by_vertex;
  by_vertex.curvature_spread = 0;
  EXPECT_GT(solve_frame_field(rough, by_vertex, RunContext{}).cone_count(), 40);
}

TEST(SmoothConnection, TurnsMoveCurvatureToWhereThereIsLess) {
  for (const bool is_closed : {true, false}) {
    const TriangleMesh smooth = is_closed ? test::icosphere(4) : test::flat_grid(20, 20, 1.4, 1.4);
    const WorkingSurface rough = surface_of(roughened(smooth, 0.03), 0.3, 200);
    const TriangleMesh& mesh = rough.mesh;
    const FaceAngles angles(mesh);
    const std::vector<double> turns = turns_for_average_curvature(rough, angles, 1);
    std::vector<double> own(mesh.vertex_count(), 2 * M_PI), turning(mesh.vertex_count(), 0);
    for (int h = 0; h < mesh.halfedge_count(); ++h) {
      own[mesh.from(h)] -= angles.corner(h);
      turning[mesh.to(h)] += turns[h];  // counterclockwise around a vertex one leaves a face by the half-edge that ends there
      EXPECT_EQ(turns[h], mesh.is_boundary(h) ? 0 : -turns[mesh.opposite(h)]);
    }
    double sum = 0, own_square = 0, averaged_square = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.is_boundary_vertex(v)) {
        EXPECT_EQ(turning[v], 0);
        continue;
      }
      sum += turning[v];
      own_square += own[v] * own[v];
      averaged_square += (own[v] + turning[v]) * (own[v] + turning[v]);
    }
    EXPECT_NEAR(sum, 0, 1e-9);
    EXPECT_LT(averaged_square, 0.05 * own_square);
  }
  // An even sphere's curvature is as even as it can be.
  const WorkingSurface sphere = surface_of(test::icosphere(4), 0.3, 200);
  for (const double turn : turns_for_average_curvature(sphere, FaceAngles(sphere.mesh), 1)) EXPECT_LT(std::abs(turn), 0.005);
}

/// A flat triangle with a right angle and legs 1 and tan(degrees); vertex 0 is the tip, the last one the other tip.
TriangleMesh right_triangle(int n, double degrees) {
  const double rise = std::tan(degrees * 3.14159265358979323846 / 180);
  std::vector<Vector3> positions;
  std::vector<std::array<int, 3>> faces;
  const auto at = [](int i, int j) { return i * (i + 1) / 2 + j; };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= i; ++j) positions.emplace_back(double(i) / n, rise * j / n, 0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (j < i) faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return {positions, faces};
}

TEST(FrameField, OneQuadBeginsAtATipOfHalfARightAngle) {
  for (const double length : {0.02, 0.03, 0.05, 0.1}) {
    const WorkingSurface surface = surface_of(right_triangle(60, 45), length, 40);
    const FrameField field = solved(surface);
    EXPECT_TRUE(violations_of(field, surface).empty());
    const FaceAngles angles(surface.mesh);
    const std::vector<double> directions = frame_directions(surface.mesh, field.du, field.dv);
    EXPECT_EQ(quarters_at(surface.mesh, angles, directions, 0), 1) << length;
    EXPECT_EQ(quarters_at(surface.mesh, angles, directions, surface.mesh.vertex_count() - 1), 1) << length;
    EXPECT_EQ(index_sum(field), 1) << length << ": three corners of one quad each leave one quarter inside";
  }
}

TEST(AcuteTips, OnlyLongTipsOfSomeWidthAreOpened) {
  const auto opening = [](double degrees, double length) {
    const WorkingSurface surface = surface_of(right_triangle(40, degrees), length, 40);
    const FaceAngles angles(surface.mesh);
    const std::vector<double> turns = turns_that_open_tips(surface, angles);
    double around = 0;  // the tip, from one side to the other
    for (int h = surface.mesh.outgoing(0); !surface.mesh.is_boundary(TriangleMesh::previous(h)); h = surface.mesh.rotate_ccw(h))
      around += turns[TriangleMesh::previous(h)];
    for (int h = 0; h < surface.mesh.halfedge_count(); ++h)
      if (!surface.mesh.is_boundary(h)) {
        EXPECT_EQ(turns[h], -turns[surface.mesh.opposite(h)]);
      }
    return std::make_pair(around, *std::max_element(turns.begin(), turns.end()));
  };
  EXPECT_GT(opening(30, 0.05).second, 0.01);
  EXPECT_EQ(opening(30, 0.3).second, 0) << "a side of three quads";
  EXPECT_EQ(opening(15, 0.02).second, 0);
}

TEST(FrameField, StrongConesAreSplit) {
  // A spike with a right angle left around its tip: three quarters of a turn are missing there.
  const int n = 24;
  std::vector<Vector3> positions{Vector3(0, 0, 4)};
  std::vector<std::array<int, 3>> faces;
  for (int ring = 1; ring <= 6; ++ring)
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979323846 * i / n;
      positions.push_back(Vector3(ring / 6.0 * std::cos(angle), ring / 6.0 * std::sin(angle), 4.0 - 4.0 * ring / 6));
    }
  const auto at = [n](int ring, int i) { return 1 + (ring - 1) * n + i % n; };
  for (int i = 0; i < n; ++i) {
    faces.push_back({0, at(1, i), at(1, i + 1)});
    for (int ring = 1; ring < 6; ++ring) {
      faces.push_back({at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
      faces.push_back({at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)});
    }
  }
  const WorkingSurface surface = surface_of(TriangleMesh(positions, faces), 0.5, 200);
  const FrameField field = solved(surface);
  EXPECT_TRUE(violations_of(field, surface).empty());
  for (const auto index : field.cone_index) EXPECT_LE(std::abs(index), 1);
}

TEST(FrameField, NeighbouringConesThatCancelAreCancelled) {
  // A constant field, of which the two frames beside an edge are turned apart by more than an eighth.
  const WorkingSurface surface = surface_of(test::flat_grid(12, 12), 0.2, 200);
  const TriangleMesh& mesh = surface.mesh;
  const FaceAngles angles(mesh);
  const FrameField even = test::constant_frames(surface, Vector3::UnitX(), Vector3::UnitY());
  std::vector<double> directions = frame_directions(mesh, even.du, even.dv);
  int inner = -1;
  for (int h = 0; h < mesh.halfedge_count() && inner < 0; ++h) {
    const auto is_inside = [&](int v) { return (mesh.position(v) - Vector3(0.5, 0.5, 0)).norm() < 0.2; };
    if (is_inside(mesh.from(h)) && is_inside(mesh.to(h))) inner = h;
  }
  directions[inner / 3] += 0.42;
  directions[mesh.opposite(inner) / 3] -= 0.42;
  const auto cones = [&] {
    int count = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v)
      count += !mesh.is_boundary_vertex(v) && quarters_at(mesh, angles, directions, v) != 0;
    return count;
  };
  EXPECT_EQ(cones(), 2);
  EXPECT_EQ(cancel_cones(surface, angles, directions), 1);
  EXPECT_EQ(cones(), 0);
  EXPECT_EQ(cancel_cones(surface, angles, directions), 0);
}

TEST(FrameField, SolutionWithLessEnergyOrFewerConesIsKept) {
  for (const TriangleMesh& mesh : {test::icosphere(4), test::torus(40, 20), test::box(6)}) {
    const WorkingSurface surface = surface_of(mesh, 0.2, 40);
    const FrameField field = solved(surface);
    const FieldSolution solutions[] = {field.choice.relaxed, field.choice.smoothest};
    const FieldSolution &kept = solutions[field.choice.kept], &other = solutions[1 - field.choice.kept];
    EXPECT_FALSE(other.quarters < kept.quarters && other.energy < kept.energy);
    EXPECT_EQ(field.singularity_count(), kept.quarters);
  }
}

TEST(FrameField, ThreadsMakeNoDifference) {
  const WorkingSurface surface = surface_of(moved(test::icosphere(4), Vector3(1, 0.6, 0.4).asDiagonal()), 0.1, 200);
  RunContext two;
  two.threads = 2;
  const FrameField field = solved(surface), again = solve_frame_field(surface, FrameFieldOptions{}, two);
  EXPECT_EQ(field.choice.kept, again.choice.kept);
  for (int f = 0; f < surface.mesh.face_count(); ++f) ASSERT_EQ(field.du[f], again.du[f]);
}

TEST(SmoothestCrosses, FlatConnectionIsSolvedExactly) {
  // A path of nodes, each a known turn from the one before, with its first node pulled: the field is parallel.
  constexpr int kNodes = 40;
  CrossSystem system;
  system.diagonal.assign(kNodes, 0);
  system.source.assign(kNodes, Complex(0, 0));
  for (int i = 0; i + 1 < kNodes; ++i) {
    system.links.push_back({i, i + 1, std::polar(1.0 + i % 3, 0.7 * i)});
    system.diagonal[i] += 1.0 + i % 3;
    system.diagonal[i + 1] += 1.0 + i % 3;
  }
  system.source[0] = std::polar(1.0, 0.3);
  system.diagonal[0] += 1.0;
  const auto levels = cross_hierarchy(system, 300, RunContext{});
  for (const auto& z : {smoothest_crosses(levels, 3, RunContext{}), relax_crosses(levels, 10, RunContext{})}) {
    double angle = 0.3;
    for (int i = 0; i < kNodes; ++i) {
      EXPECT_LT(std::abs(z[i] - std::polar(1.0, angle)), 1e-6) << i;
      angle += 0.7 * i;
    }
    EXPECT_NEAR(cross_energy(system, z), -1.0, 1e-6);  // nothing but the pull's constant
  }
}

TEST(FrameField, SeveralComponentsAndAnEmptyMesh) {
  const TriangleMesh sphere = test::icosphere(3), sheet = test::flat_grid(4, 4);
  std::vector<Vector3> positions = sphere.positions();
  std::vector<std::array<int, 3>> faces = sphere.faces();
  const int offset = sphere.vertex_count();
  positions.insert(positions.end(), sheet.positions().begin(), sheet.positions().end());
  for (const auto& t : sheet.faces()) faces.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  const WorkingSurface surface = surface_of(TriangleMesh(positions, faces), 0.3, 40);
  EXPECT_TRUE(violations_of(solved(surface), surface).empty());
  const WorkingSurface empty = surface_of(TriangleMesh(), 1, 40);
  EXPECT_EQ(solved(empty).cone_count(), 0);
}

}  // namespace
}  // namespace hybrid_quad
