#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace hybrid_quad {

/// Calls work(i) for i in [0, count) on up to `threads` threads, the caller's among them. Each i is done once; which
/// thread does it must not matter to the result. The exception of the lowest i that threw is thrown again.
template <class Work>
void parallel_for(int count, int threads, const Work& work) {
  std::atomic<int> next{0};
  std::vector<std::exception_ptr> errors(std::max(count, 0));
  std::atomic<bool> failed{false};
  const auto run = [&] {
    for (int i = next++; i < count && !failed; i = next++) {
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();
        failed = true;
      }
    }
  };
  std::vector<std::thread> pool;
  for (int t = 1; t < std::min(threads, count); ++t) pool.emplace_back(run);
  run();
  for (std::thread& t : pool) t.join();
  for (const std::exception_ptr& e : errors)
    if (e) std::rethrow_exception(e);
}

}  // namespace hybrid_quad
