#pragma once

#include <string>
#include <vector>

#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {

/// Seconds and peak memory a stage, summed where a stage runs again (components, passes), side by side too.
class StageClock {
 public:
  /// Runs `work` and books its time under `name`.
  template <class Work>
  auto measure(const std::string& name, Work work) {
    const Booking booking(*this, name);
    return work();
  }

  /// Books what another clock measured.
  void add(const StageClock& other);

  std::vector<StageRecord> records;

 private:
  StageRecord& record_of(const std::string& name);

  class Booking {
   public:
    Booking(StageClock& clock, const std::string& name);
    ~Booking();
    Booking(const Booking&) = delete;
    Booking& operator=(const Booking&) = delete;

   private:
    StageClock& clock_;
    const std::string name_;
    double begin_;
  };
};

}  // namespace hybrid_quad
