#pragma once

#include <complex>
#include <cstdint>
#include <vector>

namespace hybrid_quad {

using Complex = std::complex<double>;

/// x y of finite numbers. The operator looks after infinities, which takes longer than the product.
inline Complex times(const Complex& x, const Complex& y) {
  return {x.real() * y.real() - x.imag() * y.imag(), x.real() * y.imag() + x.imag() * y.real()};
}
/// Real part of conj(x) y.
inline double real_product(const Complex& x, const Complex& y) { return x.real() * y.real() + x.imag() * y.imag(); }

/// Wants z[to] = (weight / |weight|) z[from], with stiffness |weight|.
struct CrossLink {
  int from, to;  ///< from < to
  Complex weight;
};

/// Unit complex numbers on the nodes of a graph with a unitary connection: minimise
///   sum over links |w| |z_to - (w / |w|) z_from|^2  +  what fixed neighbours pull (`source`, counted in `diagonal`).
struct CrossSystem {
  std::vector<CrossLink> links;
  std::vector<double> diagonal;
  std::vector<Complex> source;
  int size() const { return static_cast<int>(diagonal.size()); }
};

/// A direction that depends on the index alone, for starts that must not favour any field.
Complex scattered_cross(std::uint64_t index, std::uint64_t seed);

/// Scales every value to |z| = 1; those that vanish get scattered directions.
void normalise_crosses(std::vector<Complex>& values, std::uint64_t seed);

/// What is minimised, for |z| = 1, but for a constant: the pulls' own strengths.
double cross_energy(const CrossSystem& system, const std::vector<Complex>& z);

}  // namespace hybrid_quad
