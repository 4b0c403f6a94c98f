#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <utility>

#include "callback_bridge.h"
#include "hybrid_quad/base/interruptible.h"

namespace hybrid_quad {

/// What `work` gives, on a thread of its own, while this one lets Python's signal handlers run twenty times a second. What they raise,
/// as Ctrl-C does, is raised at once; the work goes on unheeded until it ends, so it must own, or share, all that it touches.
/// \pre the GIL is held; it is free meanwhile
/// \throws whatever `work` throws; pybind11::error_already_set
template <class Work>
auto heeding_signals(Work work) -> decltype(work()) {
  CallbackBridge bridge(pybind11::none(), pybind11::none(), pybind11::none(), {});
  const RunContext context = bridge.context(0, 1);
  const auto result = std::make_shared<decltype(work())>();
  try {
    const pybind11::gil_scoped_release release;
    run_interruptibly(context, 0, [result, own = std::move(work)]() mutable { *result = own(); });
  } catch (const Cancelled&) {  // a handler raised something, which is still to be told
  }
  bridge.rethrow_pending();
  return std::move(*result);
}

}  // namespace hybrid_quad
