#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <optional>
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

/// Calls work(i, context) for i in [0, count), several at once, each on its share of the threads: for what has too little to share for all of
/// them. One after the other where there are snapshots, which come in order.
template <class Work>
void side_by_side(int count, const RunContext& context, const Work& work) {
  const int together = context.on_snapshot ? 1 : std::max(1, std::min(count, context.threads));
  RunContext each = context;
  each.threads = std::max(1, context.threads / together);
  parallel_for(count, together, [&](int i) {
    std::optional<HelperThreads> helpers;  // those of the caller are busy here
    if (together > 1) helpers.emplace();
    work(i, each);
  });
}

}  // namespace hybrid_quad
