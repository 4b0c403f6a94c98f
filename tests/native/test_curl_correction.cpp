#include "hybrid_quad/sizing/curl_correction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "hybrid_quad/sizing/disk_cut.h"
#include "support/grid_surfaces.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

using test::surface_of;

/// Three times as long as high, and dented.
TriangleMesh pebble() {
  const TriangleMesh sphere = test::icosphere(4);
  std::vector<Vector3> positions = sphere.positions();
  for (Vector3& p : positions) p = (1 + 0.2 * std::sin(3 * p.x() + p.y())) * p.cwiseProduct(Vector3(1, 0.6, 0.35));
  return {positions, sphere.faces()};
}

FrameField field_on(const WorkingSurface& surface) {
  FrameField field = solve_frame_field(surface, FrameFieldOptions{}, RunContext{});
  for (int f = 0; f < surface.mesh.face_count(); ++f) {
    field.du[f] /= surface.target_length[f];
    field.dv[f] /= surface.target_length[f];
  }
  return field;
}

std::vector<WorkingSurface> surfaces() {
  return {surface_of(pebble(), 0.1, 200), surface_of(test::torus(40, 20), 0.2, 200), surface_of(test::flat_grid(12, 9), 0.1, 40),
          surface_of(test::open_cylinder(24, 12), 0.2, 40), surface_of(test::box(8), 0.125, 40)};
}

std::set<int> cut_halfedges(const TriangleMesh& mesh, const DiskCut& cut) {
  std::set<int> all;
  for (const int h : cut.cut) all.insert({h, mesh.opposite(h)});
  return all;
}

/// Quarter turns from a frame once around an inner vertex, back to it.
int turns_around(const TriangleMesh& mesh, const FrameField& field, int v) {
  int turns = 0, h = mesh.outgoing(v);
  do {
    turns += field.matching[TriangleMesh::previous(h)];
    h = mesh.rotate_ccw(h);
  } while (h != mesh.outgoing(v));
  return turns & 3;
}

TEST(DiskCut, PiecesAreDisks) {
  for (const WorkingSurface& surface : surfaces()) {
    const TriangleMesh& mesh = surface.mesh;
    const DiskCut cut = cut_to_disks(mesh, field_on(surface).matching);
    int edges = 0;
    for (int h = 0; h < mesh.halfedge_count(); ++h) edges += h > mesh.opposite(h);
    edges += static_cast<int>(cut.cut.size());
    ASSERT_EQ(cut.piece_node.size(), 1u);
    EXPECT_EQ(static_cast<int>(cut.node_vertex.size()) - edges + mesh.face_count(), 1);
  }
}

TEST(DiskCut, CornersShareNodesButAcrossCuts) {
  for (const WorkingSurface& surface : surfaces()) {
    const TriangleMesh& mesh = surface.mesh;
    const FrameField field = field_on(surface);
    const DiskCut cut = cut_to_disks(mesh, field.matching);
    const std::set<int> cuts = cut_halfedges(mesh, cut);
    for (int h = 0; h < mesh.halfedge_count(); ++h) {
      ASSERT_EQ(cut.node_vertex[cut.node[h]], mesh.from(h));
      const int o = mesh.opposite(h);
      if (o < 0 || cuts.count(h) > 0) continue;
      EXPECT_EQ(field.matching[h], 0);
      EXPECT_EQ(cut.node[h], cut.node[TriangleMesh::next(o)]);
      EXPECT_EQ(cut.node[TriangleMesh::next(h)], cut.node[o]);
    }
  }
}

TEST(DiskCut, EndsInsideOnlyWhereFramesTurn) {
  for (const WorkingSurface& surface : surfaces()) {
    const TriangleMesh& mesh = surface.mesh;
    const FrameField field = field_on(surface);
    const DiskCut cut = cut_to_disks(mesh, field.matching);
    std::vector<int> cuts(mesh.vertex_count(), 0);
    for (const int h : cut_halfedges(mesh, cut)) ++cuts[mesh.from(h)];
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      if (cuts[v] != 1 || mesh.is_boundary_vertex(v)) continue;
      EXPECT_NE(turns_around(mesh, field, v), 0);
    }
  }
  const WorkingSurface flat = surface_of(test::flat_grid(12, 9), 0.1, 40);
  EXPECT_TRUE(cut_to_disks(flat.mesh, field_on(flat).matching).cut.empty());
}

/// Either form of the same problem gives what the other does where lambda is at the border between them.
TEST(CurlCorrection, PotentialsAgreeWithMultipliers) {
  for (const WorkingSurface& surface : surfaces()) {
    const FrameField field = field_on(surface);
    CurlCorrectionOptions options;
    options.curl_weight = kMostForPotentials;
    const auto x = curl_correction(surface, field, options, RunContext{});
    options.curl_weight *= 1 + 1e-9;
    const auto y = curl_correction(surface, field, options, RunContext{});
    double difference = 0, total = 0;
    for (int f = 0; f < surface.mesh.face_count(); ++f)
      for (int i = 0; i < 4; ++i) {
        difference += surface.mesh.area(f) * std::pow(x[f][i] - y[f][i], 2);
        total += surface.mesh.area(f);
      }
    EXPECT_LT(std::sqrt(difference / total), 0.01);
  }
}

TEST(CurlCorrection, PotentialsLeaveNoCurlToSpeakOf) {
  for (const WorkingSurface& surface : surfaces()) {
    FrameField field = field_on(surface);
    const double before = curl_of(surface.mesh, field);
    const auto x = curl_correction(surface, field, CurlCorrectionOptions{}, RunContext{});
    for (int f = 0; f < surface.mesh.face_count(); ++f) {
      const Vector3 du = field.du[f], dv = field.dv[f];
      field.du[f] = x[f][0] * du + x[f][1] * dv;
      field.dv[f] = x[f][2] * du + x[f][3] * dv;
    }
    EXPECT_LT(curl_of(surface.mesh, field), std::max(0.02 * before, 1e-6));
  }
}

TEST(CurlCorrection, LastDigitsOfCoordinatesMakeNoDifference) {
  // Edges of the boundary from a few millionths of the whole on: the springs along these must not drown the faces.
  const TriangleMesh grid = test::flat_grid(24, 16);
  std::vector<Vector3> positions = grid.positions();
  for (Vector3& p : positions) p = Vector3(std::pow(p.x(), 4), p.y(), 0.3 * std::sin(3 * p.x() + 2 * p.y()));
  const WorkingSurface surface = surface_of(TriangleMesh(positions, grid.faces()), 0.1, 40);
  std::mt19937 random(5);
  for (Vector3& p : positions)
    for (int i = 0; i < 3; ++i) p[i] += 1e-15 * (2.0 * random() / 4294967295.0 - 1);
  const WorkingSurface nearly = surface_of(TriangleMesh(positions, grid.faces()), 0.1, 40);
  const FrameField field = field_on(surface);
  const auto x = curl_correction(surface, field, CurlCorrectionOptions{}, RunContext{});
  const auto y = curl_correction(nearly, field, CurlCorrectionOptions{}, RunContext{});
  double largest = 0, corrected = 0;
  for (std::size_t f = 0; f < x.size(); ++f)
    for (int i = 0; i < 4; ++i) {
      largest = std::max(largest, std::abs(x[f][i] - y[f][i]));
      corrected = std::max(corrected, std::abs(x[f][i] - (i == 0 || i == 3)));
    }
  EXPECT_GT(corrected, 0.1) << "there is something to correct";
  EXPECT_LT(largest, 1e-8);
}

}  // namespace
}  // namespace hybrid_quad
