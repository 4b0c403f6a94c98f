#include "hybrid_quad/pipeline/count_search.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

double CountSearch::error(double got) const { return std::abs(std::log(std::max(got, 1.0) / wanted_)); }

bool CountSearch::is_stuck() const {
  constexpr double kFar = 0.3, kNextToNothing = 0.1;
  if (samples_.size() < 2) return false;
  const Sample &last = samples_.back(), &before = samples_[samples_.size() - 2];
  const double step = std::abs(last.asked - before.asked);
  return step > kFar && std::abs(last.got - before.got) < kNextToNothing * step;
}

void CountSearch::record(double got) {
  constexpr double kLeastSlope = 0.4, kMostSlope = 2.5, kLongestStep = 0.9;
  const Sample now{std::log(next_ / wanted_), std::log(std::max(got, 1.0) / wanted_)};
  // The slope to the sample that is nearest to what is wanted.
  double slope = 1;
  const auto nearest = std::min_element(samples_.begin(), samples_.end(),
                                        [](const Sample& a, const Sample& b) { return std::abs(a.got) < std::abs(b.got); });
  if (nearest != samples_.end() && std::abs(nearest->asked - now.asked) > 1e-9)
    slope = std::clamp((nearest->got - now.got) / (nearest->asked - now.asked), kLeastSlope, kMostSlope);
  const Sample from = nearest != samples_.end() && std::abs(nearest->got) < std::abs(now.got) ? *nearest : now;
  samples_.push_back(now);
  next_ = std::max(least_, wanted_ * std::exp(from.asked + std::clamp(-from.got / slope, -kLongestStep, kLongestStep)));
}

}  // namespace hybrid_quad
