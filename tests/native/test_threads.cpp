// The whole pipeline on several threads, and two runs at once: what a thread sanitizer has to see.
#include <gtest/gtest.h>

#include <thread>

#include "hybrid_quad/pipeline/remesh.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

PolygonSoup soup_of(const TriangleMesh& mesh) {
  PolygonSoup soup;
  soup.positions = mesh.positions();
  for (const auto& face : mesh.faces()) {
    soup.face_sizes.push_back(3);
    soup.face_vertices.insert(soup.face_vertices.end(), face.begin(), face.end());
  }
  return soup;
}

RemeshResult run(const PolygonSoup& soup, int threads) {
  RemeshOptions options;
  options.quads = 120;
  RunContext context;
  context.threads = threads;
  context.stop_requested = [] { return false; };
  return remesh(soup, options, context);
}

TEST(Threads, AnyNumberGivesTheSameBits) {
  const PolygonSoup soup = soup_of(test::flat_grid(12, 12));
  const RemeshResult one = run(soup, 1);
  for (const int threads : {2, 4}) {
    const RemeshResult many = run(soup, threads);
    EXPECT_EQ(many.mesh.positions, one.mesh.positions);
    EXPECT_EQ(many.mesh.quads, one.mesh.quads);
  }
}

TEST(Threads, RunsDoNotDisturbEachOther) {
  const PolygonSoup soup = soup_of(test::flat_grid(12, 12));
  const RemeshResult alone = run(soup, 2);
  RemeshResult first, second;
  std::thread other([&] { first = run(soup, 2); });
  second = run(soup, 2);
  other.join();
  EXPECT_EQ(first.mesh.positions, alone.mesh.positions);
  EXPECT_EQ(second.mesh.positions, alone.mesh.positions);
}

}  // namespace
}  // namespace hybrid_quad
