#include <gtest/gtest.h>

#include "hybrid_quad/singular_patches/patch_room.h"

namespace hybrid_quad {
namespace {

/// A strip of squares of side 1, each a piece on a face of its own. \param lengths  asked for on these faces
struct Strip {
  explicit Strip(const std::vector<double>& lengths) {
    surface.target_length = lengths;
    const int count = static_cast<int>(lengths.size());
    for (int i = 0; i <= count; ++i)
      for (const double y : {0.0, 1.0}) {
        GridOverlay::Vertex vertex;
        vertex.position = {static_cast<double>(i), y, 0};
        overlay.vertices.push_back(vertex);
      }
    overlay.piece_begin = {0};
    for (int i = 0; i < count; ++i) {
      for (const int v : {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1}) overlay.origin.push_back(v);
      overlay.piece_begin.push_back(static_cast<int>(overlay.origin.size()));
      overlay.piece_face.push_back(i);
    }
  }
  double quads(const std::vector<int>& pieces) const { return quads_by_area(surface, overlay, pieces); }

  WorkingSurface surface;
  GridOverlay overlay;
};

TEST(PatchRoom, EachPlaceHasQuadsOfItsOwnLength) {
  EXPECT_NEAR(Strip({1, 1, 1}).quads({0, 1, 2}), 3, 1e-12);
  const Strip strip({1, 0.5, 0.25});
  EXPECT_NEAR(strip.quads({0, 1, 2}), 1 + 4 + 16, 1e-12);
  EXPECT_NEAR(strip.quads({2, 0}), 16 + 1, 1e-12) << "whichever piece comes first";
  EXPECT_EQ(strip.quads({}), 0);
}

}  // namespace
}  // namespace hybrid_quad
