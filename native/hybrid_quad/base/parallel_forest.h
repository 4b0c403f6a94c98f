#pragma once

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <queue>
#include <vector>

#include "hybrid_quad/base/helper_threads.h"

namespace hybrid_quad {

/// Calls work(i) for every node of a forest on up to `threads` threads, the caller's among them, each node after all its
/// children. Which thread does it, and in which order, must not matter to the result. Nodes with higher numbers first.
/// \param parent  of every node, with a higher number, or -1
/// \throws what the lowest node that failed threw; no further nodes are begun then
template <class Work>
void parallel_forest(const std::vector<int>& parent, int threads, const Work& work) {
  const int count = static_cast<int>(parent.size());
  std::vector<int> waits_for(count, 0);
  for (const int p : parent)
    if (p >= 0) ++waits_for[p];
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
      if (parent[i] >= 0 && --waits_for[parent[i]] == 0) ready.push(parent[i]);
      changed.notify_all();
    }
  };
  run_on_threads(std::min(threads, count), run);
  if (error) std::rethrow_exception(error);
}

}  // namespace hybrid_quad
