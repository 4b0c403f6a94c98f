#include "hybrid_quad/sizing/sizing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_quad/sizing/curl_correction.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

using test::surface_of;

double area_in_quads(const TriangleMesh& mesh, const FrameField& field) {
  double sum = 0;
  for (int f = 0; f < mesh.face_count(); ++f)
    sum += mesh.area(f) * field.du[f].cross(field.dv[f]).dot(mesh.normal(f));
  return sum;
}

FrameField solved(const WorkingSurface& surface) { return solve_frame_field(surface, FrameFieldOptions{}, RunContext{}); }

/// An ellipsoid with a bump: nothing about it is symmetric or integrable.
TriangleMesh bumpy(double scale = 1) {
  const TriangleMesh sphere = test::icosphere(4);
  std::vector<Vector3> positions = sphere.positions();
  for (Vector3& p : positions) {
    p *= 1 + 0.25 * std::sin(3 * p.x() + 1) * std::cos(2 * p.y());
    p = scale * p.cwiseProduct(Vector3(1, 0.7, 0.5));
  }
  return {positions, sphere.faces()};
}

SizedFrames sized(const WorkingSurface& surface, const FrameField& field, double quads, bool correct, bool conformal) {
  SizingOptions options;
  options.correct_curl = correct;
  options.conformal = conformal;
  return apply_sizing(surface, field, quads, options, RunContext{});
}

TEST(Sizing, FlatGridStaysAsItIs) {
  const WorkingSurface surface = surface_of(test::flat_grid(10, 10, 5, 5), 0.5, 40);
  const SizedFrames result = sized(surface, solved(surface), 0, true, false);
  EXPECT_NEAR(result.mean_correction, 0, 1e-6);
  EXPECT_NEAR(area_in_quads(surface.mesh, result.field), 100, 1e-6);
  for (int f = 0; f < surface.mesh.face_count(); ++f) EXPECT_NEAR(result.field.du[f].norm(), 2, 1e-5);
}

TEST(Sizing, NoFrameIsEverTurnedOver) {
  WorkingSurface surface = surface_of(bumpy(), 0.1, 200);
  for (int f = 0; f < surface.mesh.face_count(); ++f)
    if (surface.mesh.position(surface.mesh.face(f)[0]).x() > 0) surface.target_length[f] *= 3;  // a jump: as rough as can be
  const FrameField unit = solved(surface);
  for (const double weight : {1e-10, 1e-5, 1e-3, 1.0, 100.0}) {
    SizingOptions options;
    options.curl_weight = weight;
    const SizedFrames result = apply_sizing(surface, unit, 400, options, RunContext{});
    for (int f = 0; f < surface.mesh.face_count(); ++f)
      ASSERT_GT(result.field.du[f].cross(result.field.dv[f]).dot(surface.mesh.normal(f)), 0) << weight;
  }
}

TEST(Sizing, CorrectionLowersCurlAndKeepsTheField) {
  const WorkingSurface surface = surface_of(bumpy(), 0.1, 200);
  const FrameField unit = solved(surface);
  for (const bool conformal : {false, true}) {
    const SizedFrames plain = sized(surface, unit, 400, false, conformal), corrected = sized(surface, unit, 400, true, conformal);
    EXPECT_LT(curl_of(surface.mesh, corrected.field), 0.5 * curl_of(surface.mesh, plain.field));
    EXPECT_EQ(corrected.field.matching, unit.matching);
    EXPECT_EQ(corrected.field.cone_index, unit.cone_index);
    EXPECT_TRUE(violations_of(corrected.field, surface).empty());
    EXPECT_NEAR(area_in_quads(surface.mesh, corrected.field), 400, 1e-6);
    EXPECT_GT(corrected.mean_correction, 0);
    EXPECT_LT(corrected.mean_correction, 0.5);
  }
}

TEST(Sizing, ConformalFactorAloneMakesTheCorrectionSmaller) {
  const WorkingSurface surface = surface_of(bumpy(), 0.1, 200);
  const FrameField unit = solved(surface);
  EXPECT_LT(sized(surface, unit, 400, true, true).mean_correction, sized(surface, unit, 400, true, false).mean_correction);
}

TEST(Sizing, LargeLambdaKeepsTheAskedFrames) {
  const WorkingSurface surface = surface_of(bumpy(), 0.1, 200);
  SizingOptions options;
  options.curl_weight = 1e6;
  EXPECT_LT(apply_sizing(surface, solved(surface), 400, options, RunContext{}).mean_correction, 1e-3);
}

TEST(Sizing, FeatureEdgesStayIsolines) {
  // A rhombic prism: the frames cannot be square and aligned at once, so the correction has something to do.
  const TriangleMesh cube = test::box(8);
  std::vector<Vector3> positions = cube.positions();
  for (Vector3& p : positions) p.x() += 0.3 * p.y() + 0.2 * std::sin(3 * p.z());
  const WorkingSurface surface = surface_of(TriangleMesh(positions, cube.faces()), 0.1, 40);
  const SizedFrames result = sized(surface, solved(surface), 600, true, false);
  EXPECT_TRUE(violations_of(result.field, surface).empty());
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    int features = 0, feature = -1;
    for (int h = 3 * f; h < 3 * f + 3; ++h)
      if (surface.features.is_feature(h)) ++features, feature = h;
    if (features != 1) continue;
    const Vector2 d = result.field.grid_vector(surface.mesh, feature);
    EXPECT_LT(std::min(std::abs(d[0]), std::abs(d[1])), 1e-6 * d.norm());
  }
}

TEST(Sizing, ScaleOfTheSceneDoesNotMatter) {
  const WorkingSurface reference = surface_of(bumpy(), 0.1, 200);
  const double correction = sized(reference, solved(reference), 0, true, true).mean_correction;
  for (const double scale : {std::ldexp(1.0, -100), std::ldexp(1.0, 20)}) {  // powers of two: nothing is rounded
    const WorkingSurface surface = surface_of(bumpy(scale), 0.1 * scale, 200);
    const SizedFrames result = sized(surface, solved(surface), 0, true, true);
    EXPECT_NEAR(result.mean_correction, correction, 1e-9 * correction);
    EXPECT_TRUE(violations_of(result.field, surface).empty());
  }
}

TEST(Sizing, VaryingTargetLengthsAreFollowed) {
  WorkingSurface surface = surface_of(test::flat_grid(20, 20, 1, 1), 0.05, 40);
  for (int f = 0; f < surface.mesh.face_count(); ++f)
    surface.target_length[f] *= surface.mesh.position(surface.mesh.face(f)[0]).x() < 0.5 ? 1 : 1.5;
  double asked = 0;
  for (int f = 0; f < surface.mesh.face_count(); ++f) asked += surface.mesh.area(f) / std::pow(surface.target_length[f], 2);
  const SizedFrames result = sized(surface, solved(surface), 0, true, false);
  EXPECT_TRUE(violations_of(result.field, surface).empty());
  EXPECT_NEAR(area_in_quads(surface.mesh, result.field), asked, 1e-6 * asked);
}

}  // namespace
}  // namespace hybrid_quad
