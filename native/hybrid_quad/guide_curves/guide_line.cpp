#include "hybrid_quad/guide_curves/guide_curves.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

namespace {

constexpr int kWindow = 2;  ///< samples either way: a tenth of an edge each

std::vector<std::array<Vector3, 2>> segments_of(const StrokeTrace& trace) {
  std::vector<std::array<Vector3, 2>> segments;
  for (const StrokeTrace::Run& run : trace.runs)
    for (std::size_t i = 0; i + 1 < run.samples.size(); ++i)
      segments.push_back({run.samples[i].position, run.samples[i + 1].position});
  return segments;
}

/// The chord about sample i of a run.
Vector3 along_at(const StrokeTrace::Run& run, int i) {
  const int last = static_cast<int>(run.samples.size()) - 1;  // of a closed run the first again
  int from = i - kWindow, to = i + kWindow;
  if (run.closed && last > 2 * kWindow) {
    from = (from + last) % last;
    to = to % last;
  }
  return (run.samples[std::min(to, last)].position - run.samples[std::max(from, 0)].position).normalized();
}

}  // namespace

GuideLine::GuideLine(const StrokeTrace& trace) : segments_(segments_of(trace)), index_(segments_) {
  for (const StrokeTrace::Run& run : trace.runs)
    for (int i = 0; i + 1 < static_cast<int>(run.samples.size()); ++i) along_.push_back({along_at(run, i), along_at(run, i + 1)});
}

GuideLine::Place GuideLine::nearest(const Vector3& p) const {
  const SegmentPoint found = index_.nearest(p);
  const auto& [begin, end] = segments_[found.segment];
  const auto& [first, last] = along_[found.segment];
  Vector3 along = ((1 - found.fraction) * first + found.fraction * last).normalized();
  if (!(along.squaredNorm() > 0)) along = first;
  return {begin + found.fraction * (end - begin), along, std::sqrt(found.squared_distance)};
}

double GuideLine::length() const {
  double sum = 0;
  for (const auto& [begin, end] : segments_) sum += (end - begin).norm();
  return sum;
}

}  // namespace hybrid_quad
