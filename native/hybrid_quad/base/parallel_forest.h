#pragma once

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <queue>
#include <utility>
#include <vector>

#include "hybrid_quad/base/helper_threads.h"

namespace hybrid_quad {

/// Calls work(i) for every i on up to `threads` threads, the caller's among them, as soon as all that it waits for is done. Which
/// thread does it, and in which order, must not matter to the result. Higher numbers first.
/// \param waits_for  of how many others each waits
/// \param release  release(i, done) calls done(j) for every j that waits for i
/// \throws what the lowest i that failed threw; nothing further is begun then
template <class Release, class Work>
void parallel_in_order(std::vector<int> waits_for, int threads, const Release& release, const Work& work) {
  const int count = static_cast<int>(waits_for.size());
  std::priority_queue<int> ready;
  for (int i = 0; i < count; ++i)
    if (waits_for[i] == 0) ready.push(i);
  std::mutex mutex;
  std::condition_variable changed;
  int left = count, failed = count;
  std::exception_ptr error;
  const auto run = [&] {
    std::unique_lock<std::mutex> lock(mutex);
    while (true) {
      changed.wait(lock, [&] { return !ready.empty() || left == 0 || error; });
      if (left == 0 || error) return;
      const int i = ready.top();
      ready.pop();
      lock.unlock();
      std::exception_ptr thrown;
      try {
        work(i);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      --left;
      if (thrown && i < failed) {
        failed = i;
        error = thrown;
      }
      release(i, [&](int j) {
        if (--waits_for[j] == 0) ready.push(j);
      });
      changed.notify_all();
    }
  };
  run_on_threads(std::min(threads, count), run);
  if (error) std::rethrow_exception(error);
}

/// parallel_in_order for the nodes of a forest, each after all its children.
/// \param parent  of every node, with a higher number, or -1
template <class Work>
void parallel_forest(const std::vector<int>& parent, int threads, const Work& work) {
  std::vector<int> waits_for(parent.size(), 0);
  for (const int p : parent)
    if (p >= 0) ++waits_for[p];
  const auto release = [&](int i, const auto& done) {
    if (parent[i] >= 0) done(parent[i]);
  };
  parallel_in_order(std::move(waits_for), threads, release, work);
}

/// The same, each node after its parent.
template <class Work>
void parallel_forest_downwards(const std::vector<int>& parent, int threads, const Work& work) {
  std::vector<int> waits_for(parent.size(), 0);
  std::vector<std::vector<int>> children(parent.size());
  for (int i = 0; i < static_cast<int>(parent.size()); ++i) {
    if (parent[i] < 0) continue;
    waits_for[i] = 1;
    children[parent[i]].push_back(i);
  }
  const auto release = [&](int i, const auto& done) {
    for (const int child : children[i]) done(child);
  };
  parallel_in_order(std::move(waits_for), threads, release, work);
}

}  // namespace hybrid_quad
