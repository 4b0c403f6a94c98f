#pragma once

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/smoother.h"

namespace hybrid_quad {

/// What improving asks of a Smoother.
SmootherOptions smoothing_of(const ImproveOptions& options, int threads);

}  // namespace hybrid_quad
