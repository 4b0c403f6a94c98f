#pragma once

#include <vector>

namespace hybrid_quad {

/// Which number of quads to ask for so that as many come out as are wanted: rounding to whole quads, features and
/// improvement make fewer or more of them. Secant steps in the logarithms, between what gave too few and what gave too many.
class CountSearch {
 public:
  /// \param least  fewer are never asked for
  explicit CountSearch(double wanted, double least = 0) : wanted_(wanted), least_(least), next_(wanted) {}

  double next() const { return next_; }  ///< to ask for
  bool at_least() const { return next_ <= least_; }
  /// What came out of asking for next().
  void record(double got);
  /// Whether asking for far fewer or more made next to no difference: features leave no other number.
  bool is_stuck() const;

 private:
  struct Sample {
    double asked, got;  // logarithms, of the wanted number's
  };
  /// A step that is not near either end of what is known to give too few and too many.
  double between(double asked) const;
  /// The nearest number that was not asked for: what comes out of few quads on a surface with detail leaps about.
  double unasked(double asked) const;

  double wanted_, least_, next_;
  std::vector<Sample> samples_;
};

}  // namespace hybrid_quad
