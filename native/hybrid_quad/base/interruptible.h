#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "hybrid_quad/base/run_context.h"

namespace hybrid_quad {

/// Runs a library's call that takes long and knows nothing of cancelling: on a thread of its own, while this one reports
/// progress and answers requests to stop. After a stop the work goes on unheeded until it ends, so it must share the
/// ownership of all it touches. Without anyone to ask for a stop, or another thread to be had, it runs right here.
/// \throws Cancelled if the caller asked to stop; whatever `work` throws
template <class Work>
void run_interruptibly(const RunContext& context, double fraction, Work work) {
  context.checkpoint(fraction);
  if (!context.stop_requested) {
    work();
    return;
  }
  constexpr std::chrono::milliseconds kPoll(50);
  auto task = std::make_shared<std::packaged_task<void()>>(std::move(work));
  std::future<void> done = task->get_future();
  try {
    std::thread([task] { (*task)(); }).detach();
  } catch (const std::system_error&) {  // no thread to be had
    (*task)();
  }
  while (done.wait_for(kPoll) != std::future_status::ready) context.checkpoint(fraction);
  done.get();
}

}  // namespace hybrid_quad
