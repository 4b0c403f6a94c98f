#pragma once

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace hybrid_quad {

/// Helpers that wait for the next loop of the thread that made this, for as long as it exists: to start and join a thread takes
/// longer than many a loop. Between runs there are none, so that a process may fork then.
class HelperThreads {
 public:
  HelperThreads() : before_(of_this_thread()) { of_this_thread() = this; }
  ~HelperThreads() {
    of_this_thread() = before_;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    for (std::thread& t : threads_) t.join();
  }
  HelperThreads(const HelperThreads&) = delete;
  HelperThreads& operator=(const HelperThreads&) = delete;

  /// The latest of this thread; null where there is none.
  static HelperThreads*& of_this_thread() {
    thread_local HelperThreads* latest = nullptr;
    return latest;
  }

  /// Has up to `count` helpers call work, which must stay until finish(). \returns whether they are free for it
  bool begin(int count, std::function<void()> work) {
    if (is_busy_) return false;  // in a loop inside of a loop
    try {
      while (static_cast<int>(threads_.size()) < count) threads_.emplace_back([this, i = static_cast<int>(threads_.size()), seen = round_] { help(i, seen); });
    } catch (const std::system_error&) {
    } catch (const std::bad_alloc&) {
    }
    is_busy_ = true;
    const std::lock_guard<std::mutex> lock(mutex_);
    work_ = std::move(work);
    wanted_ = std::min(count, static_cast<int>(threads_.size()));
    working_ = wanted_;
    ++round_;
    changed_.notify_all();
    return true;
  }

  void finish() {
    std::unique_lock<std::mutex> lock(mutex_);
    done_.wait(lock, [&] { return working_ == 0; });
    work_ = nullptr;
    is_busy_ = false;
  }

 private:
  void help(int index, long long seen) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return ends_ || round_ != seen; });
      if (ends_) return;
      seen = round_;
      if (index >= wanted_) continue;
      lock.unlock();
      work_();
      lock.lock();
      if (--working_ == 0) done_.notify_one();
    }
  }

  HelperThreads* before_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable changed_, done_;
  std::function<void()> work_;
  int wanted_ = 0, working_ = 0;
  long long round_ = 0;
  bool ends_ = false;
  bool is_busy_ = false;  ///< known to the thread that made this alone
};

/// Calls work() on up to `threads` threads at once, the caller's among them. Where the system gives no more of them, those
/// that there are must do, so `work` takes what is left to do from a common store. It must not throw.
template <class Work>
void run_on_threads(int threads, const Work& work) {
  if (threads <= 1) {
    work();
    return;
  }
  HelperThreads* const waiting = HelperThreads::of_this_thread();
  if (waiting && waiting->begin(threads - 1, [&work] { work(); })) {
    work();
    waiting->finish();
    return;
  }
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
