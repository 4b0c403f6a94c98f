#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/singular_patches/patch_growth.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

/// Cells of a flat grid, each one piece, row after row.
RegularQuads grid_of_cells(int columns, int rows) {
  RegularQuads out;
  GridOverlay& overlay = out.overlay;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) overlay.vertices.push_back({Vector3(i, j, 0), -1, static_cast<std::int8_t>((i + j) % 2 ? 1 : -1)});
  std::map<std::pair<int, int>, int> halfedge_of;
  overlay.piece_begin.push_back(0);
  for (int cell = 0; cell < columns * rows; ++cell) {
    const int a = cell / columns * (columns + 1) + cell % columns;
    const std::array<int, 4> corners{a, a + 1, a + columns + 2, a + columns + 1};
    std::array<int, 4> side{};
    for (int i = 0; i < 4; ++i) {
      const int k = side[i] = static_cast<int>(overlay.origin.size());
      overlay.origin.push_back(corners[i]);
      overlay.piece_of.push_back(cell);
      halfedge_of[{corners[i], corners[(i + 1) % 4]}] = k;
      const auto other = halfedge_of.find({corners[(i + 1) % 4], corners[i]});
      overlay.opposite.push_back(other == halfedge_of.end() ? -1 : other->second);
      if (other != halfedge_of.end()) overlay.opposite[other->second] = k;
    }
    overlay.piece_begin.push_back(static_cast<int>(overlay.origin.size()));
    overlay.piece_face.push_back(cell);
    out.piece_cell.push_back(cell);
    out.side.push_back(side);
  }
  overlay.on_isoline.assign(overlay.origin.size(), 1);
  overlay.curve.assign(overlay.origin.size(), -1);
  return out;
}

/// Opens side k between two cells: what lies between is a patch of two arcs.
void open_side(RegularQuads& quads, int k) {
  GridOverlay& overlay = quads.overlay;
  const int begin = static_cast<int>(overlay.origin.size()), piece = overlay.piece_count();
  const int o = overlay.opposite[k];
  for (const int beside : {k, o}) {
    const int added = static_cast<int>(overlay.origin.size());
    overlay.origin.push_back(overlay.target(beside));
    overlay.opposite.push_back(beside);
    overlay.opposite[beside] = added;
    overlay.piece_of.push_back(piece);
    overlay.on_isoline.push_back(1);
    overlay.curve.push_back(-1);
  }
  overlay.piece_begin.push_back(begin + 2);
  overlay.piece_face.push_back(piece);
  quads.piece_cell.push_back(-1);
}

TEST(PatchGrowth, APatchOfTwoArcsTakesInTheCellsAtBoth) {
  RegularQuads quads = grid_of_cells(5, 5);
  const int middle = 12, right = quads.side[middle][1];
  open_side(quads, right);
  EXPECT_EQ(grow_over_short_loops(quads), 2);
  EXPECT_EQ(quads.side.size(), 23u);
  ASSERT_EQ(find_patches(quads).size(), 1u);
  EXPECT_EQ(find_patches(quads).front(), (std::vector<int>{12, 13, 25}));
  EXPECT_TRUE(violations_of(quads).empty());
}

TEST(PatchGrowth, NotAcrossAFeature) {
  RegularQuads quads = grid_of_cells(5, 5);
  const int right = quads.side[12][1];
  open_side(quads, right);
  for (const int k : {right, quads.overlay.opposite[right]}) quads.overlay.curve[k] = 0;
  EXPECT_EQ(grow_over_short_loops(quads), 1) << "the cell on the other side";
  EXPECT_EQ(quads.piece_cell[12], 12);
}

TEST(PatchGrowth, OtherPatchesStayAsTheyAre) {
  RegularQuads quads = grid_of_cells(5, 5);
  EXPECT_EQ(grow(quads, {{12}}, {}), 0);
  EXPECT_EQ(grow_over_short_loops(quads), 0);
}

/// Near its tip a spike is two quads around, however many of them one goes back from it.
TEST(PatchGrowth, ASpikeNeedsNoFallBack) {
  PolygonSoup spike;
  spike.positions = {Vector3(1, 0, 0), Vector3(-.5, .8, 0), Vector3(-.5, -.8, 0), Vector3(0, 0, 20)};
  spike.face_sizes = {3, 3, 3, 3};
  spike.face_vertices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  RemeshOptions options;
  options.quads = 100;
  options.use_sharp_angle = false;
  const RemeshResult result = remesh(spike, options, RunContext{});
  EXPECT_TRUE(violations_of(result.mesh).empty());
  EXPECT_EQ(result.report.flawed_quads, 0);
  EXPECT_EQ(result.report.repairs.broken_promises, 0);
}

}  // namespace
}  // namespace hybrid_quad
