#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/base/snapshot.h"

namespace hybrid_quad {

class StageCache;

/// Everything a run shares with its caller. Passed down by const reference; there is no global state, so two runs
/// at once give what they give alone.
struct RunContext {
  std::function<void(const std::string& stage, double fraction)> on_progress;  ///< fraction of the whole run, 0..1
  std::function<bool()> stop_requested;                                        ///< polled several times a second
  std::function<void(const Snapshot&)> on_snapshot;                            ///< empty: no snapshots are made
  std::uint64_t seed = 0;
  int threads = 1;  ///< results do not depend on it
  StageCache* cache = nullptr;  ///< of what earlier runs of the caller gave; null: none

  std::string stage;          ///< name of the stage that runs now
  double stage_begin = 0.0;   ///< its share of the whole run
  double stage_end = 1.0;

  /// This context, narrowed to the part [begin, end] of this one under a stage's name.
  RunContext in_stage(const std::string& name, double begin, double end) const {
    RunContext c = *this;
    c.stage = name;
    c.stage_begin = stage_begin + begin * (stage_end - stage_begin);
    c.stage_end = stage_begin + end * (stage_end - stage_begin);
    return c;
  }

  /// Reports progress and answers a request to stop. Call it at least every 0.2 s of work.
  /// \param fraction of the current stage, 0..1
  /// \throws Cancelled if the caller asked to stop
  void checkpoint(double fraction = 0.0) const {
    if (stop_requested && stop_requested()) throw Cancelled("cancelled during " + (stage.empty() ? "start" : stage));
    if (on_progress) on_progress(stage, stage_begin + fraction * (stage_end - stage_begin));
  }

  /// The same at every 65536th step of a loop, whose steps take some microseconds at most.
  void checkpoint_at(std::size_t step) const {
    if ((step & 0xffff) == 0) checkpoint();
  }
};

}  // namespace hybrid_quad
