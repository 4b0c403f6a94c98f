#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <string>

#include "hybrid_quad/base/run_context.h"

namespace hybrid_quad {

/// What a run may take; <= 0: as much as it likes.
struct RunLimits {
  double seconds = 0;    ///< from the start of the run
  double memory_mb = 0;  ///< resident memory of the process
};

/// Carries a run's progress, snapshots and request to stop between the core, which runs without the GIL, and Python.
///
/// Python is entered at most twenty times a second, whatever the number of checkpoints; each time its signal handlers run
/// too, so that Ctrl-C stops a run. An exception raised in Python stops the run at once and is kept until the GIL is back
/// (rethrow_pending), so that no stage of the core can mistake it for one of its own.
class CallbackBridge {
 public:
  /// Any of the callables may be None.
  CallbackBridge(pybind11::object progress, pybind11::object cancel, pybind11::object snapshot, const RunLimits& limits);
  CallbackBridge(const CallbackBridge&) = delete;
  CallbackBridge& operator=(const CallbackBridge&) = delete;

  /// A context that calls this object, which must outlive it.
  RunContext context(std::uint64_t seed, int threads);

  /// Reports the end, whenever the last report was. \pre the GIL is held
  void finish(const std::string& stage);
  /// \pre the GIL is held
  void rethrow_pending();
  /// Why the run was stopped, where no caller asked for it: "time_limit" or "memory_limit"; otherwise empty.
  std::string passed_limit() const { return timed_out_ ? "time_limit" : out_of_memory_ ? "memory_limit" : ""; }

 private:
  using Clock = std::chrono::steady_clock;

  bool stop_requested();
  void report(const std::string& stage, double fraction);
  void take_snapshot(const Snapshot& snapshot);
  /// Runs `call` with the GIL; keeps what it throws and stops the run.
  template <typename Call>
  void in_python(const Call& call);

  const pybind11::object progress_, cancel_, snapshot_;
  const bool has_deadline_;
  const Clock::time_point deadline_;
  const double memory_limit_;
  std::mutex mutex_;  ///< always taken before the GIL, never while it is held
  Clock::time_point next_poll_, next_report_;
  double reported_ = 0.0;
  std::exception_ptr pending_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> timed_out_{false}, out_of_memory_{false};
};

/// A dict with the fields of Snapshot, as numpy arrays.
pybind11::dict dict_of_snapshot(const Snapshot& snapshot);

}  // namespace hybrid_quad
