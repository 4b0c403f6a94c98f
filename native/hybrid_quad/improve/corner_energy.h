#pragma once

#include <cmath>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// What the energy of a quad's corners needs to know of the quad, held fixed during a sweep.
struct QuadFrame {
  Vector3 normal = Vector3::Zero();     ///< unit; agrees with the input below the quad
  Vector3 reference = Vector3::Zero();  ///< unit normal of the input below the quad
  double aspect = 1;                    ///< weight of sides 0 and 2 against sides 1 and 3
  double area = 0;                      ///< that corner parallelograms are to have
};

/// Energy of one corner with sides e1, e2 (to the next and to the previous corner), and its derivatives:
///   f = (w |e1|^2 + |e2|^2 / w) / (2 chi(D)) + lambda/2 (chi(D) / A + A / chi(D)),  D = n . (e1 x e2),
///   energy f^2. chi(D) = (D + sqrt(D^2 + eps^2 A^2)) / 2 keeps it finite at D <= 0 (Garanzha et al. 2021,
/// "Foldover-free maps in 50 lines of code"). With w the ratio of the sides' lengths to some power, f is smallest for
/// right angles at that ratio.
struct CornerEnergy {
  double value = 0;              ///< f
  double by_length = 0;          ///< df/dL, L = w |e1|^2 + |e2|^2 / w
  double by_area = 0;            ///< df/dD
  double by_length_area = 0;     ///< second derivatives, chi linearised
  double by_area_area = 0;

  static double regularized(double d, double size, double* slope) {
    const double root = std::sqrt(d * d + size * size);
    const double chi = d >= 0 ? 0.5 * (d + root) : 0.5 * size * size / (root - d);
    *slope = root > 0 ? chi / root : 0.0;
    return chi;
  }
  static double value_of(double length, double d, double area, double eps, double area_weight) {
    double slope;
    const double chi = regularized(d, eps * area, &slope);
    const double f = length / (2 * chi) + 0.5 * area_weight * (chi / area + area / chi);
    return f * f;
  }
  CornerEnergy(double length, double d, double area, double eps, double area_weight) {
    double slope;
    const double chi = regularized(d, eps * area, &slope);
    const double inverse = 1 / chi;
    value = 0.5 * length * inverse + 0.5 * area_weight * (chi / area + area * inverse);
    by_length = 0.5 * inverse;
    const double by_chi = -0.5 * length * inverse * inverse + 0.5 * area_weight * (1 / area - area * inverse * inverse);
    const double by_chi_chi = (length + area_weight * area) * inverse * inverse * inverse;
    by_area = by_chi * slope;
    by_length_area = -0.5 * inverse * inverse * slope;
    by_area_area = by_chi_chi * slope * slope;
  }
};

}  // namespace hybrid_quad
