#pragma once

#include <string>
#include <vector>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/pipeline/broken_promises.h"

namespace hybrid_quad {

/// How the extraction is tried when a stage's promise breaks: as designed, with integers as Psi gives them, and with no
/// regular part at all, where only the patches' guarantee is needed.
enum class Attempt { kFull, kWithoutCancellation, kPatchesOnly };

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
