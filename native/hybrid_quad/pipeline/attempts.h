#pragma once

#include <string>
#include <vector>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {

/// How the extraction is tried when a stage's promise breaks: as designed, with integers as Psi gives them, and with no
/// regular part at all, where only the patches' guarantee is needed.
enum class Attempt { kFull, kWithoutCancellation, kPatchesOnly };

/// A promise that broke, and that something else took the place of.
inline void record_broken_promise(const InternalError& error, RepairRecord& repairs, std::vector<std::string>& warnings) {
  ++repairs.broken_promises;
  warnings.push_back(std::string("fell back after a broken promise in ") + error.what());
}

/// What `extract(attempt)` gives in the first attempt that keeps its promises; those that do not are recorded.
/// \throws InternalError of the last attempt
template <class Extract>
auto extract_by_any_means(const Extract& extract, RepairRecord& repairs, std::vector<std::string>& warnings) {
  for (const Attempt attempt : {Attempt::kFull, Attempt::kWithoutCancellation}) {
    try {
      return extract(attempt);
    } catch (const InternalError& error) {
      record_broken_promise(error, repairs, warnings);
    }
  }
  return extract(Attempt::kPatchesOnly);
}

}  // namespace hybrid_quad
