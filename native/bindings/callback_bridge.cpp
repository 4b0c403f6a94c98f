#include "callback_bridge.h"

#include <algorithm>
#include <utility>

#include "hybrid_quad/pipeline/process_memory.h"
#include "polygon_arrays.h"

namespace py = pybind11;

namespace hybrid_quad {
namespace {

constexpr std::chrono::milliseconds kInterval{50};
constexpr double kLongestLimit = 1e9;  // seconds; more would overflow the clock

std::chrono::steady_clock::duration seconds(double value) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(std::min(value, kLongestLimit)));
}

py::dict dict_of_arrays(const std::map<std::string, std::vector<double>>& values, py::ssize_t columns) {
  py::dict result;
  for (const auto& [name, data] : values) {
    py::array_t<double> array = array_from_values(data);
    result[py::str(name)] = columns == 1 ? py::object(array) : array.attr("reshape")(-1, columns);
  }
  return result;
}

}  // namespace

CallbackBridge::CallbackBridge(py::object progress, py::object cancel, py::object snapshot, const RunLimits& limits)
    : progress_(std::move(progress)),
      cancel_(std::move(cancel)),
      snapshot_(std::move(snapshot)),
      has_deadline_(limits.seconds > 0),
      deadline_(Clock::now() + (has_deadline_ ? seconds(limits.seconds) : Clock::duration::zero())),
      memory_limit_(limits.memory_mb),
      next_poll_(Clock::now()),
      next_report_(Clock::now()) {}

RunContext CallbackBridge::context(std::uint64_t seed, int threads) {
  RunContext context;
  context.seed = seed;
  context.threads = threads;
  context.stop_requested = [this] { return stop_requested(); };
  if (!progress_.is_none())
    context.on_progress = [this](const std::string& stage, double fraction) { report(stage, fraction); };
  if (!snapshot_.is_none()) context.on_snapshot = [this](const Snapshot& snapshot) { take_snapshot(snapshot); };
  return context;
}

template <typename Call>
void CallbackBridge::in_python(const Call& call) {
  const py::gil_scoped_acquire gil;
  try {
    call();
  } catch (...) {
    if (!pending_) pending_ = std::current_exception();
    stop_ = true;
  }
}

bool CallbackBridge::stop_requested() {
  if (stop_) return true;
  const Clock::time_point now = Clock::now();
  if (has_deadline_ && now >= deadline_) {
    timed_out_ = true;
    stop_ = true;
    return true;
  }
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock() || now < next_poll_) return false;  // another thread asks right now
  next_poll_ = now + kInterval;
  if (memory_limit_ > 0 && resident_memory_mb() > memory_limit_) {
    out_of_memory_ = true;
    stop_ = true;
    return true;
  }
  in_python([this] {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!cancel_.is_none() && py::cast<bool>(py::bool_(cancel_()))) stop_ = true;
  });
  return stop_;
}

void CallbackBridge::report(const std::string& stage, double fraction) {
  const Clock::time_point now = Clock::now();
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || now < next_report_ || stop_) return;
    next_report_ = now + kInterval;
    // A stage may be entered again for another component; what the caller sees never runs backwards.
    reported_ = std::max(reported_, std::min(std::max(fraction, 0.0), 1.0));
    in_python([&] { progress_(stage, reported_); });
  }
  if (stop_) throw Cancelled("stopped by the progress callback");
}

void CallbackBridge::take_snapshot(const Snapshot& snapshot) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stop_) return;
    in_python([&] { snapshot_(dict_of_snapshot(snapshot)); });
  }
  if (stop_) throw Cancelled("stopped by the snapshot callback");
}

void CallbackBridge::finish(const std::string& stage) {
  if (!progress_.is_none()) progress_(stage, 1.0);
}

void CallbackBridge::rethrow_pending() {
  if (pending_) std::rethrow_exception(std::exchange(pending_, nullptr));
}

py::dict dict_of_snapshot(const Snapshot& snapshot) {
  py::dict result;
  result["stage"] = snapshot.stage;
  result["points"] = array_from_points(snapshot.points);
  result["face_sizes"] = array_from_values(snapshot.face_sizes);
  result["face_vertices"] = array_from_values(snapshot.face_vertices);
  result["vertex_values"] = dict_of_arrays(snapshot.vertex_values, 1);
  result["face_values"] = dict_of_arrays(snapshot.face_values, 1);
  result["face_vectors"] = dict_of_arrays(snapshot.face_vectors, 3);
  result["lines"] = array_from_rows(snapshot.lines);
  return result;
}

}  // namespace hybrid_quad
