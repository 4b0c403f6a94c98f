#include <gtest/gtest.h>

#include <set>

#include "hybrid_quad/features/features_with_room.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

FeatureGraph features_of(const TriangleMesh& mesh) { return detect_features(mesh, FeatureOptions{}, RunContext{}); }

std::set<int> remaining_curves(const FeatureGraph& features, const std::vector<char>& remains) {
  std::set<int> curves;
  for (std::size_t h = 0; h < remains.size(); ++h)
    if (remains[h]) curves.insert(features.halfedge_curve[h]);
  return curves;
}

std::vector<char> none(const TriangleMesh& mesh) { return std::vector<char>(mesh.halfedge_count(), 0); }

TEST(FeaturesWithRoom, AllStayWhereThereIsRoom) {
  const TriangleMesh box = test::box(6);
  const FeatureGraph features = features_of(box);
  EXPECT_EQ(remaining_curves(features, features_with_room(box, features, none(box), 0.2, RunContext{})).size(), 12u);
}

TEST(FeaturesWithRoom, ThinSlabKeepsOneRimOfTwo) {
  const TriangleMesh slab = test::box(12, Vector3(4, 4, 0.1));
  const FeatureGraph features = features_of(slab);
  const std::set<int> curves = remaining_curves(features, features_with_room(slab, features, none(slab), 0.3, RunContext{}));
  EXPECT_EQ(curves.size(), 4u);
  for (const int c : curves) EXPECT_GT(features.curves[c].vertices.size(), 2u);
  // The short edges between the rims are none of them.
  for (const int c : curves) {
    const auto& v = features.curves[c].vertices;
    EXPECT_GT((slab.position(v.front()) - slab.position(v.back())).norm(), 1);
  }
}

TEST(FeaturesWithRoom, GivenOnesStay) {
  const TriangleMesh slab = test::box(12, Vector3(4, 4, 0.1));
  const FeatureGraph features = features_of(slab);
  std::vector<char> given = none(slab);
  for (int h = 0; h < slab.halfedge_count(); ++h) given[h] = features.halfedge_curve[h] >= 0 && features.halfedge_curve[h] % 2 == 0;
  const std::vector<char> remains = features_with_room(slab, features, given, 0.3, RunContext{});
  for (int h = 0; h < slab.halfedge_count(); ++h) EXPECT_GE(remains[h], given[h]);
  const TriangleMesh grid = test::flat_grid(6, 6, 1, 0.05);
  const FeatureGraph boundary = features_of(grid);
  EXPECT_EQ(remaining_curves(boundary, features_with_room(grid, boundary, none(grid), 1, RunContext{})).size(), boundary.curves.size());
}

TEST(FeaturesWithRoom, BothSidesOfAnEdgeAgree) {
  const TriangleMesh can = test::capped_cylinder(48, 4, 1, 0.2);
  const FeatureGraph features = features_of(can);
  ASSERT_EQ(features.curves.size(), 2u);
  const std::vector<char> remains = features_with_room(can, features, none(can), 0.4, RunContext{});
  for (int h = 0; h < can.halfedge_count(); ++h) EXPECT_EQ(remains[h], remains[can.opposite(h)]);
  EXPECT_EQ(remaining_curves(features, remains).size(), 1u);
  // A circle that is not long enough to go around a quad goes too.
  EXPECT_TRUE(remaining_curves(features, features_with_room(can, features, none(can), 2, RunContext{})).empty());
}

}  // namespace
}  // namespace hybrid_quad
