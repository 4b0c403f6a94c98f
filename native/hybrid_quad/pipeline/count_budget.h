#pragma once

#include <algorithm>

#include "hybrid_quad/pipeline/size_plan.h"

namespace hybrid_quad {

/// What components cost more or less than they were planned to, those that are left pay or get: a component has its least
/// number of quads, and few quads come in steps.
class CountBudget {
 public:
  /// \param wanted  quads in all
  CountBudget(const std::vector<ComponentPlan>& plans, double wanted) : left_(wanted) {
    for (const ComponentPlan& plan : plans) planned_ += plan.quads;
  }

  /// What to multiply the planned quads of a component that is left with.
  double factor() const {
    constexpr double kLeast = 0.5, kMost = 1.5;
    return planned_ > 0 ? std::clamp(left_ / planned_, kLeast, kMost) : 1;
  }
  /// Quads for a component that is left, of those that are left, whatever it can do with.
  double share(double planned) const { return planned_ > 0 ? std::max(0.0, left_) * planned / planned_ : planned; }
  void spend(double planned, double got) {
    planned_ -= planned;
    left_ -= got;
  }

 private:
  double left_, planned_ = 0;
};

}  // namespace hybrid_quad
