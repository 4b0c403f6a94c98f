// Marks, counts and values at vertices of a dirty input, after its repair.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "hybrid_quad/pipeline/asked_after_repair.h"
#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {
namespace {

using Edges = std::vector<std::array<int, 2>>;

/// Two unit squares side by side, each with vertices of its own: 1 and 2 of the first lie where 4 and 7 of the second do.
PolygonSoup two_squares() {
  PolygonSoup soup;
  for (const double x : {0.0, 1.0})
    for (const auto& [dx, dy] : {std::array<double, 2>{0, 0}, {1, 0}, {1, 1}, {0, 1}}) soup.positions.push_back(Vector3(x + dx, dy, 0));
  soup.face_sizes = {4, 4};
  soup.face_vertices = {0, 1, 2, 3, 4, 5, 6, 7};
  return soup;
}

/// A square beside two half as high: vertex 4 lies in the middle of its edge from 1 to 2.
PolygonSoup split_side() {
  PolygonSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0.5, 0}, {2, 0, 0}, {2, 0.5, 0}, {2, 1, 0}};
  soup.face_sizes = {4, 4, 4};
  soup.face_vertices = {0, 1, 2, 3, 1, 5, 6, 4, 4, 6, 7, 2};
  return soup;
}

struct Asked {
  RemeshOptions options;
  std::vector<std::string> warnings;
};

Asked after_repair(const PolygonSoup& soup, const RemeshOptions& options) {
  Asked out;
  out.options = asked_after_repair(soup, build_mesh(soup), options, out.warnings);
  return out;
}

Edges sorted(Edges edges) {
  for (auto& e : edges) std::sort(e.begin(), e.end());
  std::sort(edges.begin(), edges.end());
  return edges;
}

TEST(AskedAfterRepair, MarksFollowWeldedVertices) {
  RemeshOptions options;
  options.marked_edges = {{4, 7}};
  const Asked welded = after_repair(two_squares(), options);
  EXPECT_EQ(sorted(welded.options.marked_edges), (Edges{{1, 2}}));
  EXPECT_TRUE(welded.warnings.empty());
}

TEST(AskedAfterRepair, MarksFollowTheChainThatAnEdgeWasSplitInto) {
  RemeshOptions options;
  options.marked_edges = {{1, 2}};
  const Asked split = after_repair(split_side(), options);
  EXPECT_EQ(sorted(split.options.marked_edges), (Edges{{1, 4}, {2, 4}}));
  EXPECT_TRUE(split.warnings.empty());
}

TEST(AskedAfterRepair, MarksOnACopyAreThoseOfWhatItLiesOn) {
  PolygonSoup soup = two_squares();
  const int count = static_cast<int>(soup.positions.size());
  for (int v = 0; v < 4; ++v) soup.positions.push_back(Vector3(soup.positions[v]));
  soup.face_sizes.push_back(4);
  for (int v = 0; v < 4; ++v) soup.face_vertices.push_back(count + 3 - v);
  RemeshOptions options;
  options.marked_edges = {{count, count + 3}, {0, 3}};
  const Asked left = after_repair(soup, options);
  ASSERT_EQ(left.options.marked_edges.size(), 2u);
  EXPECT_EQ(sorted(left.options.marked_edges)[0], sorted(left.options.marked_edges)[1]);
  EXPECT_TRUE(left.warnings.empty());
}

TEST(AskedAfterRepair, MarksThatAreGoneAreCounted) {
  PolygonSoup soup = two_squares();
  soup.positions.insert(soup.positions.end(), {{9, 0, 0}, {9, 1e-6, 0}, {9, 0, 1e-6}});  // a speck
  soup.face_sizes.push_back(3);
  soup.face_vertices.insert(soup.face_vertices.end(), {8, 9, 10});
  RemeshOptions options;
  options.marked_edges = {{1, 2}, {8, 9}, {9, 10}};
  const Asked left = after_repair(soup, options);
  EXPECT_EQ(sorted(left.options.marked_edges), (Edges{{1, 2}}));
  ASSERT_EQ(left.warnings.size(), 1u);
  EXPECT_EQ(left.warnings[0].rfind("2 marked edges went", 0), 0u) << left.warnings[0];
}

TEST(AskedAfterRepair, CountedCurvesFollowWeldsAndSplits) {
  RemeshOptions options;
  options.quads = 40;
  options.curve_counts = {{{7, 4}, 6}};
  EXPECT_EQ(after_repair(two_squares(), options).options.curve_counts[0].vertices, (std::vector<int>{2, 1}));
  EXPECT_EQ(remesh(two_squares(), options, {}).report.curve_counts[0].got, 6);
  options.curve_counts = {{{1, 2}, 6}};
  EXPECT_EQ(after_repair(split_side(), options).options.curve_counts[0].vertices, (std::vector<int>{1, 4, 2}));
  EXPECT_EQ(remesh(split_side(), options, {}).report.curve_counts[0].got, 6);
}

TEST(AskedAfterRepair, CurvesThatBecomeOneSaySo) {
  RemeshOptions options;
  options.quads = 40;
  options.curve_counts = {{{7, 4}, 6}, {{1, 2}, 4}};
  const auto records = remesh(two_squares(), options, {}).report.curve_counts;
  EXPECT_EQ(records[0].got, 6);
  EXPECT_NE(records[1].reason.find("another of these curves"), std::string::npos) << records[1].reason;
}

TEST(AskedAfterRepair, ValuesOfMergedVerticesAreKept) {
  RemeshOptions options;
  options.density.assign(8, 1.0);
  options.density[4] = 2;
  options.vertex_guides.assign(8, Vector3::Zero());
  options.vertex_guides[7] = Vector3(0, 1, 0);
  options.vertex_frames.assign(8, {Vector3::Zero(), Vector3::Zero()});
  options.vertex_frames[4] = {Vector3(1, 0, 0), Vector3(0, 2, 0)};
  const RemeshOptions left = after_repair(two_squares(), options).options;
  EXPECT_EQ(left.density[1], 2);
  EXPECT_EQ(left.vertex_guides[2], Vector3(0, 1, 0));
  EXPECT_EQ(left.vertex_frames[1][1], Vector3(0, 2, 0));
}

TEST(AskedAfterRepair, ValuesOfCopiesOfPolygonsAreKept) {
  PolygonSoup soup = two_squares();
  soup.face_sizes.push_back(4);
  soup.face_vertices.insert(soup.face_vertices.end(), {2, 1, 0, 3});
  const BuiltMesh built = build_mesh(soup);
  const auto is_built = [&](int f) { return std::find(built.input_face.begin(), built.input_face.end(), f) != built.input_face.end(); };
  ASSERT_NE(is_built(0), is_built(2));
  const int kept = is_built(0) ? 0 : 2;
  RemeshOptions options;
  options.face_guides.assign(3, Vector3::Zero());
  options.face_guides[2 - kept] = Vector3(0, 1, 0);
  options.face_frames.assign(3, {Vector3::Zero(), Vector3::Zero()});
  options.face_frames[2 - kept] = {Vector3(1, 0, 0), Vector3(0, 2, 0)};
  const RemeshOptions left = after_repair(soup, options).options;
  EXPECT_EQ(left.face_guides[kept], Vector3(0, 1, 0));
  EXPECT_EQ(left.face_frames[kept][1], Vector3(0, 2, 0));
}

}  // namespace
}  // namespace hybrid_quad
