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

StageRecord& StageClock::record_of(const std::string& name) {
  const auto known = std::find_if(records.begin(), records.end(), [&](const StageRecord& record) { return record.name == name; });
  if (known != records.end()) return *known;
  records.push_back({name, 0, 0});
  return records.back();
}

void StageClock::add(const StageClock& other) {
  for (const StageRecord& theirs : other.records) {
    StageRecord& record = record_of(theirs.name);
    record.seconds += theirs.seconds;
    record.peak_mb = std::max(record.peak_mb, theirs.peak_mb);
  }
}

StageClock::Booking::Booking(StageClock& clock, const std::string& name) : clock_(clock), name_(name), begin_(now()) { clock_.record_of(name); }

StageClock::Booking::~Booking() {
  StageRecord& record = clock_.record_of(name_);
  record.seconds += now() - begin_;
  record.peak_mb = std::max(record.peak_mb, peak_memory_mb());
}

}  // namespace hybrid_quad
