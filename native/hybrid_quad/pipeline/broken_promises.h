#pragma once

#include <string>
#include <vector>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/pipeline/component.h"

namespace hybrid_quad {

/// Tells in the report, by number and in a warning, of a promise that broke, and that something else took the place of.
inline void record_broken_promise(const InternalError& error, RepairRecord& repairs, std::vector<std::string>& warnings) {
  ++repairs.broken_promises;
  warnings.push_back(std::string("fell back after a broken promise in ") + error.what());
}

/// Whichever result is gone on with, what broke on the way to it is told: from one that is dropped to the one that takes its place.
inline void keep_broken_promises(const ComponentResult& dropped, ComponentResult& kept) {
  kept.repairs.broken_promises += dropped.repairs.broken_promises;
  kept.warnings.insert(kept.warnings.end(), dropped.warnings.begin(), dropped.warnings.end());
}

}  // namespace hybrid_quad
