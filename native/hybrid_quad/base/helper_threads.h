#pragma once

#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace hybrid_quad {

/// Calls work() on up to `threads` threads at once, the caller's among them. Where the system gives no more of them, those
/// that there are must do, so `work` takes what is left to do from a common store. It must not throw.
template <class Work>
void run_on_threads(int threads, const Work& work) {
  std::vector<std::thread> helpers;
  try {
    for (int t = 1; t < threads; ++t) helpers.emplace_back(work);
  } catch (const std::system_error&) {
  } catch (const std::bad_alloc&) {
  }
  work();
  for (std::thread& t : helpers) t.join();
}

}  // namespace hybrid_quad
