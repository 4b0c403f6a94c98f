#include "hybrid_quad/pipeline/process_memory.h"

#if defined(_WIN32)
#include <windows.h>
// clang-format off
#include <psapi.h>
// clang-format on
#else
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <string>
#if defined(__GLIBC__)
#include <malloc.h>
#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#endif
#if defined(__APPLE__)
#include <mach/mach.h>
#endif
#endif

namespace hybrid_quad {

namespace {

constexpr double kMegabyte = 1024.0 * 1024.0;

}  // namespace

#if defined(_WIN32)

double peak_memory_mb() {
  PROCESS_MEMORY_COUNTERS counters;
  GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof(counters));
  return static_cast<double>(counters.PeakWorkingSetSize) / kMegabyte;
}

double resident_memory_mb() {
  PROCESS_MEMORY_COUNTERS counters;
  GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof(counters));
  return static_cast<double>(counters.WorkingSetSize) / kMegabyte;
}

#else

double peak_memory_mb() {
#if defined(__linux__)
  // getrusage tells what the process that started this one had, if that was more: it outlives exec.
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kilobytes = 0; word == "VmHWM:" && status >> kilobytes) return kilobytes / 1024.0;
#endif
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#if defined(__APPLE__)
  return static_cast<double>(usage.ru_maxrss) / kMegabyte;
#else
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
#endif
}

#if defined(__APPLE__)

double resident_memory_mb() {
  mach_task_basic_info info{};
  mach_msg_type_number_t count = MACH_TASK_BASIC_INFO_COUNT;
  if (task_info(mach_task_self(), MACH_TASK_BASIC_INFO, reinterpret_cast<task_info_t>(&info), &count) != KERN_SUCCESS)
    return peak_memory_mb();
  return static_cast<double>(info.resident_size) / kMegabyte;
}

#else

double resident_memory_mb() {
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  if (!(file >> size >> resident)) return peak_memory_mb();
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / kMegabyte;
}

#endif
#endif

#if defined(__GLIBC__)
namespace {

/// Has the heap's end, which grows by `bytes` and the pad, be of pages as large as the system has them: it touches hundreds at once.
void advise_large_pages(std::size_t bytes) {
#if defined(MADV_HUGEPAGE)
  void* const grown = std::malloc(bytes);
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(grown) + page - 1) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0));
  if (grown && begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  std::free(grown);
#endif
}

}  // namespace
#endif

void keep_freed_memory() {
#if defined(__GLIBC__)
  constexpr int kMegabytes = 1 << 20;
  mallopt(M_TRIM_THRESHOLD, 256 * kMegabytes);
  mallopt(M_MMAP_THRESHOLD, 32 * kMegabytes);  // the largest that it takes
  mallopt(M_TOP_PAD, 256 * kMegabytes);
  advise_large_pages(16 * kMegabytes);
#endif
}

}  // namespace hybrid_quad
