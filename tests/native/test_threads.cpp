// The whole pipeline on several threads, and two runs at once: what a thread sanitizer has to see.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <cstdlib>
#include <numeric>
#include <thread>
#include <vector>

#include "hybrid_quad/base/helper_threads.h"
#include "hybrid_quad/base/interruptible.h"
#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/base/parallel_forest.h"
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

RemeshResult run(const PolygonSoup& soup, int threads, int quads = 120) {
  RemeshOptions options;
  options.quads = quads;
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

TEST(Threads, EveryStageGivesTheSameBits) {
  // Large enough that every stage shares its work.
  const PolygonSoup soup = soup_of(test::capped_cylinder(40, 6));
  const RemeshResult one = run(soup, 1, 2500), many = run(soup, 3, 2500);
  EXPECT_EQ(many.mesh.positions, one.mesh.positions);
  EXPECT_EQ(many.mesh.quads, one.mesh.quads);
  EXPECT_EQ(many.report.hausdorff_percent, one.report.hausdorff_percent);
}

/// Parents of the nodes of a forest, or -1.
std::vector<int> some_forest(int count) {
  std::vector<int> parent(count, -1);
  for (int i = 0; i + 1 < count; ++i) parent[i] = i % 10 == 9 ? -1 : i + 1 + (i * 7) % (count - i - 1);
  return parent;
}

TEST(Threads, NodesOfAForestComeAfterTheirChildren) {
  constexpr int kCount = 1000;
  const std::vector<int> parent = some_forest(kCount);
  std::vector<std::atomic<int>> left(kCount);
  for (const int p : parent)
    if (p >= 0) ++left[p];
  std::atomic<int> done{0}, early{0};
  parallel_forest(parent, 4, [&](int i) {
    early += left[i] != 0;
    if (parent[i] >= 0) --left[parent[i]];
    ++done;
  });
  EXPECT_EQ(done, kCount);
  EXPECT_EQ(early, 0);
}

TEST(Threads, NodesOfAForestComeAfterTheirParents) {
  constexpr int kCount = 1000;
  const std::vector<int> parent = some_forest(kCount);
  std::vector<std::atomic<int>> done(kCount);
  std::atomic<int> early{0};
  parallel_forest_downwards(parent, 4, [&](int i) {
    early += parent[i] >= 0 && done[parent[i]] == 0;
    ++done[i];
  });
  for (const auto& d : done) EXPECT_EQ(d, 1);
  EXPECT_EQ(early, 0);
}

TEST(Threads, WhatANodeThrowsEndsTheForest) {
  const std::vector<int> parent{2, 2, 3, -1};
  std::atomic<bool> root_begun{false};
  const auto work = [&](int i) {
    if (i == 1) throw Cancelled("here");
    if (i == 3) root_begun = true;
  };
  EXPECT_THROW(parallel_forest(parent, 2, work), Cancelled);
  EXPECT_FALSE(root_begun);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which reserve all addresses there are
/// Leaves no room for another thread's stack. \returns whether everything was done all the same
bool works_without_threads() {
  constexpr int kCount = 1000, kThreads = 64;
  std::vector<int> done(kCount, 0), visited(kCount, 0);
  std::vector<int> parent(kCount, -1);
  const rlimit none{0, RLIM_INFINITY};
  if (setrlimit(RLIMIT_AS, &none) != 0) return false;
  parallel_for(kCount, kThreads, [&](int i) { ++done[i]; });
  parallel_forest(parent, kThreads, [&](int i) { ++visited[i]; });
  bool ran = false;
  RunContext context;
  context.stop_requested = [] { return false; };
  run_interruptibly(context, 0.5, [&] { ran = true; });
  return ran && std::accumulate(done.begin(), done.end(), 0) == kCount && std::accumulate(visited.begin(), visited.end(), 0) == kCount;
}

TEST(Threads, WhereThereAreNoMoreTheCallersDoesItAll) {
  EXPECT_EXIT(std::_Exit(works_without_threads() ? 0 : 1), testing::ExitedWithCode(0), "");
}
#endif

TEST(Threads, HelpersThatWaitDoWhatThoseStartedForALoopDo) {
  constexpr int kLoops = 300, kCount = 40;
  const HelperThreads helpers;
  std::vector<std::atomic<int>> done(kCount);
  for (int loop = 0; loop < kLoops; ++loop) parallel_for(kCount, 1 + loop % 4, [&](int i) { ++done[i]; });
  for (const std::atomic<int>& times : done) EXPECT_EQ(times, kLoops);
}

TEST(Threads, HelpersThatWaitAreNotAskedInsideOfALoop) {
  constexpr int kOuter = 8, kInner = 50;
  const HelperThreads helpers;
  std::atomic<int> done{0};
  parallel_for(kOuter, 3, [&](int) {
    const HelperThreads inner;
    parallel_for(kInner, 3, [&](int) { ++done; });
    parallel_for(kInner, 2, [&](int) { parallel_for(2, 2, [&](int) { ++done; }); });
  });
  EXPECT_EQ(done, kOuter * kInner * 3);
  EXPECT_THROW(parallel_for(kInner, 3, [](int i) { if (i == 7) throw Cancelled("here"); }), Cancelled);
  parallel_for(kInner, 3, [&](int) { ++done; });
  EXPECT_EQ(done, kOuter * kInner * 3 + kInner);
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
