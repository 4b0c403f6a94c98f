#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {

/// The report of a run as plain Python values.
pybind11::dict dict_of_report(const RemeshReport& report);

/// [{"name", "seconds", "peak_mb"}, ...]
pybind11::list list_of_stages(const std::vector<StageRecord>& stages);

}  // namespace hybrid_quad
