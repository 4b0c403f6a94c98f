#include "hybrid_quad/improve/smoothing_options.h"

namespace hybrid_quad {

SmootherOptions smoothing_of(const ImproveOptions& options, int threads) {
  SmootherOptions smoothing;
  smoothing.chord_spring = options.chord_spring;
  smoothing.aspect_power = options.aspect_power;
  smoothing.area_weight = options.area_weight;
  smoothing.asked_lengths = options.asked_lengths;
  smoothing.guides = options.guides;
  smoothing.rings = options.rings;
  smoothing.threads = threads;
  return smoothing;
}

}  // namespace hybrid_quad
