#pragma once

#include <string>
#include <vector>

#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {

/// Seconds and peak memory a stage, summed where a stage runs again (components, passes).
class StageClock {
 public:
  /// Runs `work` and books its time under `name`.
  template <class Work>
  auto measure(const std::string& name, Work work) {
    const Booking booking(*this, name);
    return work();
  }

  std::vector<StageRecord> records;

 private:
  class Booking {
   public:
    Booking(StageClock& clock, const std::string& name);
    ~Booking();
    Booking(const Booking&) = delete;
    Booking& operator=(const Booking&) = delete;

   private:
    StageClock& clock_;
    std::size_t index_;
    double begin_;
  };
};

}  // namespace hybrid_quad
