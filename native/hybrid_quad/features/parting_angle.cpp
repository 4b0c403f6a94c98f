#include "hybrid_quad/features/parting_angle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace hybrid_quad {

namespace {

constexpr int kDegrees = 180;
constexpr int kBand = 10;             ///< degrees: bands of angles that are compared
constexpr int kStep = 5;              ///< degrees
constexpr double kTailShare = 0.35;   ///< from this length just below a limit on, as part of all above it, that is the tail of what is below
constexpr double kRounding = 1e-6;    ///< many edges have angles of whole degrees, and are in one band however the surface lies in space

/// Length of the edges by whole degrees above the sharp angle.
class AngleHistogram {
 public:
  AngleHistogram(const std::vector<BentEdge>& edges, double sharp_angle) {
    for (const BentEdge& e : edges) of_degree_[place(static_cast<int>(std::floor(e.angle - sharp_angle + kRounding)))] += e.length;
  }
  double between(int low, int high) const {
    return std::accumulate(of_degree_.begin() + place(low), of_degree_.begin() + place(high), 0.0);
  }
  double from(int low) const { return std::accumulate(of_degree_.begin() + place(low), of_degree_.end(), 0.0); }

 private:
  static int place(int above) { return std::clamp(above + kDegrees, 0, 2 * kDegrees); }
  std::array<double, 2 * kDegrees + 1> of_degree_{};
};

}  // namespace

double parting_angle(const std::vector<BentEdge>& edges, double sharp_angle) {
  const AngleHistogram length(edges, sharp_angle);
  int above = 0;
  for (; sharp_angle + above < kDegrees; above += kStep) {
    const double below = length.between(above - kBand, above);
    const bool thins_out = length.between(above - 2 * kBand, above - kBand) > below && below > length.between(above, above + kBand);
    if (!thins_out || below <= kTailShare * length.from(above)) break;
  }
  return sharp_angle + above;
}

}  // namespace hybrid_quad
