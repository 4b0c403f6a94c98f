#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "hybrid_quad/mesh/obj_text.h"

namespace hybrid_quad {
namespace {

TEST(ObjText, NumbersAreReadAsTheNearestDoubles) {
  const PolygonSoup soup = parse_obj("v 0.1 -1e-3 +2.5\nv 9007199254740993 1e400 4.9e-324\nv 1 2 3 0.5 0.5 0.5 # painted\n");
  ASSERT_EQ(soup.positions.size(), 3u);
  EXPECT_EQ(soup.positions[0], Vector3(0.1, -1e-3, 2.5));
  EXPECT_EQ(soup.positions[1].x(), 9007199254740992.0);
  EXPECT_TRUE(std::isinf(soup.positions[1].y()));
  EXPECT_EQ(soup.positions[1].z(), 4.9e-324);
  EXPECT_EQ(soup.positions[2], Vector3(1, 2, 3));
}

TEST(ObjText, WhatNamesNoVertexStaysOutOfRange) {
  const PolygonSoup soup = parse_obj("v 0 0 0\nf 1 0 -2 99999999999999999999 -99999999999999999999\n");
  EXPECT_EQ(soup.face_sizes, std::vector<int>{5});
  for (std::size_t i = 1; i < soup.face_vertices.size(); ++i)
    EXPECT_TRUE(soup.face_vertices[i] < 0 || soup.face_vertices[i] >= 1) << i;
}

TEST(ObjText, LinesAreCountedAcrossJointsAndEveryLineEnd) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string text = "# one" + end + end + "v 1 2 \\" + end + "3" + end + "f 1 1 \\" + end + "x" + end;
    try {
      parse_obj(text);
      ADD_FAILURE() << "x is no index";
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()), "line 6: 'x' is no vertex index");
    }
  }
}

TEST(ObjText, KeywordsAreWholeWords) {
  const PolygonSoup soup = parse_obj("vn 0 0 1\nvt 0 0\nface 1\nfo 1 2 3\no v 1 2 3\ng f 1 2 3\n  v 1 2 3");
  EXPECT_EQ(soup.positions.size(), 1u);
  EXPECT_TRUE(soup.face_sizes.empty());
}

// Every end of a text, in a buffer of just its size, so that the sanitizers see a step beyond it.
TEST(ObjText, CutTextsAreReadToTheirEnd) {
  const std::string whole = "v 0 -0.5e+1 nan\\\r\n inf\r\nv 1 0 0 1\\\nf 1/2/3 -1//+7\\\r# c\r\nf 2\\";
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const std::unique_ptr<char[]> copy(new char[size]);
    std::copy_n(whole.data(), size, copy.get());
    try {
      const PolygonSoup soup = parse_obj({copy.get(), size});
      EXPECT_LE(soup.positions.size(), 2u);
      EXPECT_LE(soup.face_sizes.size(), 2u);
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind("line ", 0), 0u);
    }
  }
}

TEST(ObjText, QuadsAreReadBackToTheLastBit) {
  std::vector<Vector3> positions;
  for (const double scale : {1.0, 1e-300, 1e300, 5e-324, 1.7976931348623157e308, 123456789012345680.0})
    for (const double x : {0.1, 1.0 / 3, -0.7}) positions.emplace_back(scale * x, -scale, 0.0);
  const std::vector<std::array<int, 4>> quads{{0, 1, 2, 3}, {3, 2, 17, 9}};
  const PolygonSoup soup = parse_obj(obj_text(positions, quads));
  EXPECT_EQ(soup.positions, positions);
  EXPECT_EQ(soup.face_sizes, (std::vector<int>{4, 4}));
  EXPECT_EQ(soup.face_vertices, (std::vector<int>{0, 1, 2, 3, 3, 2, 17, 9}));
}

TEST(ObjText, NumbersAreWrittenAsPrintfDoes) {
  EXPECT_EQ(obj_text({Vector3(0.1, -2, 1e-7)}, {}), "v 0.10000000000000001 -2 9.9999999999999995e-08\n");
  EXPECT_EQ(obj_text({Vector3(1e20, 3e16, 12345678901234567)}, {{0, 0, 0, 0}}), "v 1e+20 30000000000000000 12345678901234568\nf 1 1 1 1\n");
}

}  // namespace
}  // namespace hybrid_quad
