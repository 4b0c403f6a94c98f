#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

#include "hybrid_quad/base/helper_threads.h"
#include "hybrid_quad/base/run_context.h"

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
  run_on_threads(std::min(threads, count), run);
  for (const std::exception_ptr& e : errors)
    if (e) std::rethrow_exception(e);
}

/// Calls work(begin, end) for the chunks of [0, count), whose size does not depend on the number of threads; each i must be
/// independent of all others. Answers requests to stop, from any thread.
template <class Work>
void parallel_chunks(int count, const RunContext& context, const Work& work, int chunk = 256) {
  RunContext each = context;  // several at once have no common progress
  each.on_progress = nullptr;
  parallel_for((count + chunk - 1) / chunk, context.threads, [&](int c) {
    each.checkpoint();
    work(c * chunk, std::min(count, (c + 1) * chunk));
  });
}

}  // namespace hybrid_quad
