#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/quad_moves.h"
#include "hybrid_quad/improve/quad_number.h"
#include "hybrid_quad/improve/vertex_opening.h"
#include "hybrid_quad/quality/quality.h"
#include "support/meshes.h"
#include "support/quad_complexes.h"
#include "support/quad_moves.h"

namespace hybrid_quad {
namespace {

constexpr double kEnoughArea = 1e-6;

/// A closed input surface without features, and quads on it, all vertices free.
struct Covered {
  Covered(TriangleMesh mesh, QuadComplex complex)
      : input(std::move(mesh)), features(detect_features(input, no_angle(), RunContext{})), index(input, features.face_region) {
    quads = to_quad_mesh(complex_of_quads(complex.positions, to_quad_mesh(complex).quads));
    std::fill(quads.anchor.begin(), quads.anchor.end(), features.face_region[0]);
    lengths.assign(input.vertex_count(), std::sqrt(input.total_area() / static_cast<double>(quads.quads.size())));
    options.agreement.area = kEnoughArea;
  }
  static FeatureOptions no_angle() {
    FeatureOptions o;
    o.use_sharp_angle = false;
    return o;
  }
  int change_to(int wanted) {
    return change_quad_number(quads, input, features, index, options, {wanted, lengths}, RunContext{});
  }
  int count() const { return static_cast<int>(quads.quads.size()); }
  void expect_sound() const {
    EXPECT_TRUE(violations_of(quads).empty());
    EXPECT_EQ(euler_characteristic(quads), input.euler_characteristic());
    EXPECT_TRUE(flawed_quads(quads, index, {kEnoughArea}).empty());
  }

  TriangleMesh input;
  FeatureGraph features;
  SurfaceIndex index;
  ImproveOptions options;
  QuadMesh quads;
  std::vector<double> lengths;
};

Covered sphere(int n) {
  QuadComplex box = test::quad_box(n, n, n);
  Vector3 centre = Vector3::Zero();
  for (const Vector3& p : box.positions) centre += p / static_cast<double>(box.positions.size());
  for (Vector3& p : box.positions) p = (p - centre).normalized();
  return {test::icosphere(4), box};
}

Covered ring(int n, int m) {
  QuadComplex torus = test::quad_torus(n, m);
  for (std::size_t i = 0; i < torus.opposite.size(); ++i) {
    const int q = static_cast<int>(i) / 4, corner = static_cast<int>(i) % 4;
    const int around = q % n + (corner == 1 || corner == 2), along = q / n + (corner >= 2);
    const double a = 2 * M_PI * around / n, b = 2 * M_PI * along / m;
    torus.positions[torus.vertex[i]] = {(1 + 0.4 * std::cos(b)) * std::cos(a), (1 + 0.4 * std::cos(b)) * std::sin(a), 0.4 * std::sin(b)};
  }
  return {test::torus(60, 30), torus};
}

TEST(QuadNumber, TakesQuadsOutUntilThereAreAsManyAsWanted) {
  for (const int wanted : {120, 60, 20, 6}) {
    Covered covered = sphere(5);
    ASSERT_EQ(covered.count(), 150);
    EXPECT_EQ(covered.change_to(wanted), wanted - 150);
    EXPECT_EQ(covered.count(), wanted);
    covered.expect_sound();
  }
}

TEST(QuadNumber, PutsQuadsInUntilThereAreAsManyAsWanted) {
  for (const int wanted : {151, 180, 400}) {
    Covered covered = sphere(5);
    covered.change_to(wanted);
    EXPECT_EQ(covered.count(), wanted);
    covered.expect_sound();
  }
}

TEST(QuadNumber, KeepsHandles) {
  Covered covered = ring(16, 8);
  covered.expect_sound();
  covered.change_to(1);
  EXPECT_LT(covered.count(), 40);
  covered.expect_sound();
}

TEST(QuadNumber, MetNumbersChangeNothing) {
  Covered covered = sphere(4);
  const auto before = covered.quads.quads;
  EXPECT_EQ(covered.change_to(covered.count()), 0);
  EXPECT_EQ(covered.quads.quads, before);
}

TEST(QuadNumber, SmallQuadsGoFirst) {
  // Asked for three times longer edges on the upper half: it loses more quads than the lower half.
  Covered covered = sphere(8);
  for (int v = 0; v < covered.input.vertex_count(); ++v)
    if (covered.input.position(v).z() > 0) covered.lengths[v] *= 3;
  covered.change_to(260);
  int upper = 0;
  for (const auto& q : covered.quads.quads) {
    double z = 0;
    for (const int v : q) z += covered.quads.positions[v].z();
    upper += z > 0;
  }
  EXPECT_LT(upper, 100);
  covered.expect_sound();
}

TEST(QuadMoves, EveryAllowedMoveLeavesAValidMeshAndCanBeUndone) {
  // Few quads of all valences.
  Covered covered = sphere(4);
  covered.change_to(40);
  EditMesh mesh(covered.quads, covered.input, covered.features);
  int merged = 0;
  for (const auto& [move, changed] : test::allowed_moves(mesh)) {
    const std::size_t mark = mesh.mark();
    const int removed = move.collapses() ? 1 + static_cast<int>(merged_away(mesh, move).size()) : 0;
    make_move(mesh, move);
    const QuadMesh after = mesh.extract();
    EXPECT_TRUE(violations_of(after).empty());
    EXPECT_EQ(static_cast<int>(after.quads.size()), covered.count() - removed);
    merged += move.kind == Move::kCollapseAndMerge;
    mesh.undo_to(mark);
    EXPECT_EQ(mesh.extract().quads, covered.quads.quads);
  }
  EXPECT_GT(merged, 0);
}

TEST(VertexOpening, AddsAQuadAndLeavesAValidMesh) {
  Covered covered = sphere(3);
  Workpiece piece(covered.quads, covered.input, covered.features, covered.index);
  piece.bind_all();
  for (int v = 0; v < static_cast<int>(covered.quads.positions.size()); ++v)
    for (const VertexOpening& opening : openings_of(piece.mesh, v)) {
      const std::size_t mark = piece.mesh.mark();
      open_vertex(piece, opening);
      const QuadMesh after = piece.mesh.extract();
      EXPECT_TRUE(violations_of(after).empty());
      EXPECT_EQ(after.quads.size(), covered.quads.quads.size() + 1);
      EXPECT_EQ(euler_characteristic(after), 2);
      piece.mesh.undo_to(mark);
    }
}

TEST(VertexOpening, LeavesVerticesOfThreeQuadsAlone) {
  Covered covered = sphere(1);
  const EditMesh mesh(covered.quads, covered.input, covered.features);
  for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_TRUE(openings_of(mesh, v).empty());
}

}  // namespace
}  // namespace hybrid_quad
