#include "hybrid_quad/sizing/bent_curves.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

void limit_lengths_of_bends(const TriangleMesh& mesh, const FeatureCurve& curve, double length, std::vector<double>& target) {
  constexpr double kSagitta = 0.05;  // largest distance of a chord from its arc, in edge lengths
  constexpr double kLeast = 0.6;     // of the length: noise makes no short edges
  std::vector<double> arc{0};
  for (std::size_t i = 1; i < curve.vertices.size(); ++i)
    arc.push_back(arc.back() + (mesh.position(curve.vertices[i]) - mesh.position(curve.vertices[i - 1])).norm());
  const double whole = arc.back();
  if (!(whole > length)) return;
  const auto at = [&](double s) {
    s = curve.closed ? s - whole * std::floor(s / whole) : std::clamp(s, 0.0, whole);
    const std::size_t i = std::clamp<std::size_t>(std::upper_bound(arc.begin(), arc.end(), s) - arc.begin(), 1, arc.size() - 1);
    const double span = arc[i] - arc[i - 1], t = span > 0 ? (s - arc[i - 1]) / span : 0;
    return Vector3((1 - t) * mesh.position(curve.vertices[i - 1]) + t * mesh.position(curve.vertices[i]));
  };
  for (std::size_t i = 0; i < arc.size(); ++i) {
    // Of the chord of one edge length around the place.
    const double middle = curve.closed ? arc[i] : std::clamp(arc[i], length / 2, whole - length / 2);
    const Vector3 here = at(middle), before = at(middle - length / 2), after = at(middle + length / 2);
    const double sagitta = (here - 0.5 * (before + after)).norm() / length;
    if (sagitta <= kSagitta) continue;
    double& limited = target[curve.vertices[i]];
    limited = std::min(limited, length * std::max(kLeast, std::sqrt(kSagitta / sagitta)));
  }
}

}  // namespace hybrid_quad
