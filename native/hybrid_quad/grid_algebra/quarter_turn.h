#pragma once

#include <complex>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// Quarter turns k in Z/4, stored as 0..3, act on everything that lives in a face's gauge. One turn maps
///   (u, v) -> (v, -u),   (alpha, beta) -> (-beta, alpha),   (a, b) -> (conj b, a),
/// which are the same thing, because alpha = pi (u + v), beta = pi (u - v), a = e^{i alpha}, b = e^{i beta} (paper 2.3).

inline int wrap_turns(int k) { return k & 3; }
inline int inverse_turns(int k) { return (4 - (k & 3)) & 3; }

template <class Scalar>
std::array<Scalar, 2> turned(std::array<Scalar, 2> uv, int k) {
  switch (k & 3) {
    case 0: return uv;
    case 1: return {uv[1], -uv[0]};
    case 2: return {-uv[0], -uv[1]};
    default: return {-uv[1], uv[0]};
  }
}

inline Vector2 turned(const Vector2& uv, int k) {
  const auto r = turned(std::array<double, 2>{uv[0], uv[1]}, k);
  return {r[0], r[1]};
}

/// One coordinate of a turned vector: turned(x, k)[coordinate] = sign * x[source].
struct TurnedCoordinate {
  int source;
  int sign;
};
inline TurnedCoordinate turned_coordinate(int coordinate, int k) {
  constexpr TurnedCoordinate kTable[4][2] = {{{0, 1}, {1, 1}}, {{1, 1}, {0, -1}}, {{0, -1}, {1, -1}}, {{1, -1}, {0, 1}}};
  return kTable[k & 3][coordinate];
}

/// The periodic field's value at a point: a = e^{i pi (u + v)}, b = e^{i pi (u - v)} where it is exact. In the paper's
/// components Psi0 = Re(a + b) / 2, Psi1 = Im(a + b) / 2, Psi2 = Im(a - b) / 2, Psi3 = Re(b - a) / 2.
struct PhasePair {
  std::complex<double> a{1, 0};
  std::complex<double> b{1, 0};
  double morse() const { return 0.5 * (a.real() + b.real()); }  ///< Psi0 = cos(pi u) cos(pi v)
};

inline PhasePair turned(const PhasePair& z, int k) {
  switch (k & 3) {
    case 0: return z;
    case 1: return {std::conj(z.b), z.a};
    case 2: return {std::conj(z.a), std::conj(z.b)};
    default: return {z.b, std::conj(z.a)};
  }
}

}  // namespace hybrid_quad
