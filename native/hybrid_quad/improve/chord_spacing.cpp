#include "hybrid_quad/improve/chord_spacing.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

namespace {

constexpr int kHalvings = 14;

double largest_of(const CurveGeometry& curve, const std::vector<double>& arc) {
  double largest = 0;
  for (std::size_t i = 0; i + 1 < arc.size(); ++i) largest = std::max(largest, chord_deviation(curve, arc[i], arc[i + 1]));
  return largest;
}

/// Vertices as the smallest deviation allows: first as far along as each can be, from the front to the back, and then, from the back to
/// the front, as near to where they were as the one behind allows. On jagged curves, where a longer chord may be the nearer one, not all
/// ways are found.
class Placement {
 public:
  Placement(const CurveGeometry& curve, const CurveSpacing& spacing) : curve_(curve), wanted_(spacing.arc), room_(spacing.room) {}

  /// \returns whether no chord need deviate by more than `most`; `placed` then are such arc lengths
  bool place(double most, std::vector<double>& placed) {
    const int n = static_cast<int>(wanted_.size());
    farthest_.assign(n, 0.0);
    farthest_[0] = wanted_[0] + room_[0];
    for (int i = 1; i < n; ++i) {
      const double low = wanted_[i] - room_[i], high = wanted_[i] + room_[i];
      if (chord_deviation(curve_, farthest_[i - 1], low) > most) return false;
      farthest_[i] = last_within(farthest_[i - 1], low, high, most);
    }
    placed.resize(n);
    placed[n - 1] = std::min(wanted_[n - 1], farthest_[n - 1]);
    for (int i = n - 2; i >= 0; --i) {
      const double low = std::min(wanted_[i], farthest_[i]);
      placed[i] = chord_deviation(curve_, low, placed[i + 1]) <= most ? low : last_within(placed[i + 1], farthest_[i], low, most);
    }
    return largest_of(curve_, placed) <= most;
  }

 private:
  /// The arc length nearest to `bad` with a chord from `fixed` that is within `most`, between `good`, whose is, and `bad`.
  double last_within(double fixed, double good, double bad, double most) const {
    const auto deviation = [&](double s) {
      return s < fixed ? chord_deviation(curve_, s, fixed) : chord_deviation(curve_, fixed, s);
    };
    if (deviation(bad) <= most) return bad;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (good + bad);
      (deviation(middle) <= most ? good : bad) = middle;
    }
    return good;
  }

  const CurveGeometry& curve_;
  const std::vector<double>&wanted_, &room_;
  std::vector<double> farthest_;
};

/// Shares moves among neighbours, as far as no chord then deviates by more than `most`: a chord between two places that have both
/// moved is as long as it was, and the quads beside it lean, which costs them less than to be squeezed.
void share_moves(const CurveGeometry& curve, const CurveSpacing& spacing, double most, std::vector<double>& arc) {
  constexpr int kSweeps = 20;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 1; i + 1 < arc.size(); ++i) {
      const double before = arc[i - 1] - spacing.arc[i - 1], after = arc[i + 1] - spacing.arc[i + 1];
      const double wanted = spacing.arc[i] + std::clamp(0.5 * (before + after), -spacing.room[i], spacing.room[i]);
      for (const double part : {1.0, 0.5, 0.25}) {
        const double s = arc[i] + part * (wanted - arc[i]);
        if (chord_deviation(curve, arc[i - 1], s) > most || chord_deviation(curve, s, arc[i + 1]) > most) continue;
        arc[i] = s;
        break;
      }
    }
}

/// Of an open chain, whose ends have no room.
std::vector<double> spaced_between_ends(const CurveGeometry& curve, const CurveSpacing& spacing) {
  constexpr double kNearEnough = 0.01;
  constexpr double kLeftOver = 0.25;  // of what could be gained: the last of it takes the largest moves
  std::vector<double> best = spacing.arc, placed;
  const double before = largest_of(curve, spacing.arc);
  double high = before, low = 0;
  Placement placement(curve, spacing);
  while (high - low > kNearEnough * before) {
    const double middle = 0.5 * (low + high);
    if (placement.place(middle, placed)) {
      high = middle;
      best = placed;
    } else {
      low = middle;
    }
  }
  const double most = high + kLeftOver * (before - high);
  if (most < before && placement.place(most, placed)) best = placed;
  share_moves(curve, spacing, most, best);
  return best;
}

/// Arc lengths of a closed chain that go on rising, with the first one again at the end.
std::vector<double> unrolled(const CurveGeometry& curve, std::vector<double> arc) {
  for (std::size_t i = 1; i < arc.size(); ++i)
    while (arc[i] <= arc[i - 1]) arc[i] += curve.length();
  arc.push_back(arc[0] + curve.length());
  return arc;
}

}  // namespace

double chord_deviation(const CurveGeometry& curve, double from, double to) {
  const Vector3 start = curve.at(from), way = curve.at(to) - start;
  const double squared = way.squaredNorm();
  double largest = 0;
  curve.for_points_between(from, to, [&](const Vector3& p) {
    const double share = squared > 0 ? std::clamp((p - start).dot(way) / squared, 0.0, 1.0) : 0.0;
    largest = std::max(largest, (p - start - share * way).squaredNorm());
  });
  return std::sqrt(largest);
}

double largest_chord_deviation(const CurveGeometry& curve, const std::vector<double>& arc) {
  return largest_of(curve, curve.closed() && !arc.empty() ? unrolled(curve, arc) : arc);
}

std::vector<double> spaced_by_chords(const CurveGeometry& curve, const CurveSpacing& spacing) {
  if (spacing.arc.size() < 2) return spacing.arc;
  if (!curve.closed()) {
    CurveSpacing fixed = spacing;
    fixed.room.front() = fixed.room.back() = 0;
    return spaced_between_ends(curve, fixed);
  }
  // Cut open at one vertex, for which some places are tried.
  constexpr double kPlaces[] = {0, -0.8, -0.4, 0.4, 0.8};  // of its room
  std::vector<double> best = spacing.arc;
  double least = 0;
  for (const double place : kPlaces) {
    CurveSpacing open{unrolled(curve, spacing.arc), spacing.room};
    open.room.front() = 0;
    open.room.push_back(0);
    open.arc.front() += place * spacing.room.front();
    open.arc.back() += place * spacing.room.front();
    std::vector<double> placed = spaced_between_ends(curve, open);
    const double largest = largest_of(curve, placed);
    if (place != 0 && !(largest < least)) continue;
    least = largest;
    placed.pop_back();
    for (double& s : placed) s = curve.normalized(s);
    best = std::move(placed);
  }
  return best;
}

}  // namespace hybrid_quad
