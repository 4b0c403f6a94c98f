#pragma once

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "hybrid_quad/base/run_context.h"

namespace hybrid_quad {

/// How far a run is whose parts get on side by side.
class CommonProgress {
 public:
  /// \param run  outlives this  \param shares  of the parts, 1 in all  \param begin, end  what they are together of the run, 0..1
  CommonProgress(const RunContext& run, std::vector<double> shares, double begin, double end)
      : run_(run), whole_(run.in_stage(run.stage, begin, end)), share_(std::move(shares)), done_(share_.size(), 0.0) {}

  /// The run's context for a part. \param each  one of side_by_side()
  RunContext context_of(int part, const RunContext& each) {
    RunContext context = each;
    context.stage_begin = 0;
    context.stage_end = 1;
    if (run_.on_progress)
      context.on_progress = [this, part](const std::string& stage, double fraction) { report(part, stage, fraction); };
    return context;
  }

 private:
  void report(int part, const std::string& stage, double fraction) {
    double all = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      done_[part] = std::max(done_[part], fraction);
      for (std::size_t i = 0; i < share_.size(); ++i) all += share_[i] * done_[i];
    }
    run_.on_progress(stage, whole_.stage_begin + all * (whole_.stage_end - whole_.stage_begin));
  }

  const RunContext& run_;
  const RunContext whole_;
  const std::vector<double> share_;
  std::vector<double> done_;
  std::mutex mutex_;
};

}  // namespace hybrid_quad
