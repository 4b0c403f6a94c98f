// The whole pipeline on several threads, and two runs at once: what a thread sanitizer has to see.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <numeric>
#include <string>
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

/// Spheres of different sizes beside each other.
PolygonSoup some_spheres(int count) {
  PolygonSoup soup;
  for (int i = 0; i < count; ++i) {
    const PolygonSoup sphere = soup_of(test::icosphere(2));
    const int base = static_cast<int>(soup.positions.size());
    for (const Vector3& p : sphere.positions) soup.positions.push_back((1 + 0.3 * i) * p + Vector3(0, 0, 10.0 * i));
    soup.face_sizes.insert(soup.face_sizes.end(), sphere.face_sizes.begin(), sphere.face_sizes.end());
    for (const int v : sphere.face_vertices) soup.face_vertices.push_back(base + v);
  }
  return soup;
}

TEST(Threads, PartsSideBySideGiveTheSameBits) {
  const PolygonSoup soup = some_spheres(6);
  const RemeshResult one = run(soup, 1, 900);
  EXPECT_EQ(one.report.components, 6);
  EXPECT_NEAR(one.report.quads, 900, 45);
  for (const int threads : {2, 3, 8}) {
    const RemeshResult many = run(soup, threads, 900);
    EXPECT_EQ(many.mesh.positions, one.mesh.positions);
    EXPECT_EQ(many.mesh.quads, one.mesh.quads);
    ASSERT_EQ(many.report.stages.size(), one.report.stages.size());
    for (std::size_t i = 0; i < one.report.stages.size(); ++i) EXPECT_EQ(many.report.stages[i].name, one.report.stages[i].name);
  }
}

TEST(Threads, PartsSideBySideStopTogether) {
  RemeshOptions options;
  options.quads = 900;
  RunContext context;
  context.threads = 4;
  std::atomic<int> polls{0};
  context.stop_requested = [&] { return ++polls > 400; };
  EXPECT_THROW(remesh(some_spheres(6), options, context), Cancelled);
}

TEST(Threads, ProgressOfPartsSideBySideIsTheirs) {
  RunContext context;
  context.threads = 4;
  std::atomic<bool> is_sound{true};
  std::mutex mutex;
  double largest = 0;
  context.on_progress = [&](const std::string&, double fraction) {
    const std::lock_guard<std::mutex> lock(mutex);
    is_sound = is_sound && fraction >= 0 && fraction <= 1;
    largest = std::max(largest, fraction);
  };
  RemeshOptions options;
  options.quads = 900;
  options.measure_distances = false;
  remesh(some_spheres(6), options, context);
  EXPECT_TRUE(is_sound);
  EXPECT_GT(largest, 0.8);
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
