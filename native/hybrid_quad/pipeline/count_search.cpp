#include "hybrid_quad/pipeline/count_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hybrid_quad {

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
  if (nearest != samples_.end() && std::abs(nearest->asked - now.asked) > 1e-9) {
    slope = (nearest->got - now.got) / (nearest->asked - now.asked);
    // Where asking for fewer gave more, the number leaps about: no far step from the best.
    slope = slope < 0 ? kMostSlope : std::clamp(slope, kLeastSlope, kMostSlope);
  }
  const Sample from = nearest != samples_.end() && std::abs(nearest->got) < std::abs(now.got) ? *nearest : now;
  samples_.push_back(now);
  const double step = std::clamp(-from.got / slope, -kLongestStep, kLongestStep);
  next_ = std::max(least_, wanted_ * std::exp(unasked(between(from.asked + step))));
}

double CountSearch::unasked(double asked) const {
  constexpr double kSame = 1e-3, kAside = 0.04;
  const auto is_known = [&](double x) {
    return std::any_of(samples_.begin(), samples_.end(), [&](const Sample& s) { return std::abs(s.asked - x) < kSame; });
  };
  double aside = 0;
  for (; is_known(asked + aside); aside = aside > 0 ? -aside : kAside - aside) {}
  return asked + aside;
}

double CountSearch::between(double asked) const {
  constexpr double kMargin = 0.15;
  double few = -std::numeric_limits<double>::infinity(), many = std::numeric_limits<double>::infinity();
  for (const Sample& s : samples_) {
    if (s.got <= 0) few = std::max(few, s.asked);
    if (s.got >= 0) many = std::min(many, s.asked);
  }
  const double margin = kMargin * (many - few);
  return std::isfinite(margin) && margin > 0 ? std::clamp(asked, few + margin, many - margin) : asked;
}

}  // namespace hybrid_quad
