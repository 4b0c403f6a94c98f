#include "hybrid_quad/pipeline/stage_clock.h"

#include <algorithm>
#include <chrono>

#include "hybrid_quad/pipeline/process_memory.h"

namespace hybrid_quad {

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

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
