#include "hybrid_quad/pipeline/stage_clock.h"

#include <algorithm>
#include <chrono>

#if defined(_WIN32)
#include <windows.h>
// clang-format off
#include <psapi.h>
// clang-format on
#else
#include <sys/resource.h>
#endif

namespace hybrid_quad {

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

double peak_memory_mb() {
#if defined(_WIN32)
  PROCESS_MEMORY_COUNTERS counters;
  GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof(counters));
  return static_cast<double>(counters.PeakWorkingSetSize) / (1024.0 * 1024.0);
#else
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#if defined(__APPLE__)
  return static_cast<double>(usage.ru_maxrss) / (1024.0 * 1024.0);
#else
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
#endif
#endif
}

StageClock::Booking::Booking(StageClock& clock, const std::string& name) : clock_(clock), index_(0), begin_(now()) {
  while (index_ < clock_.records.size() && clock_.records[index_].name != name) ++index_;
  if (index_ == clock_.records.size()) clock_.records.push_back({name, 0, 0});
}

StageClock::Booking::~Booking() {
  StageRecord& record = clock_.records[index_];
  record.seconds += now() - begin_;
  record.peak_mb = std::max(record.peak_mb, peak_memory_mb());
}

}  // namespace hybrid_quad
