#include "hybrid_quad/frame_field/cross_system.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

Complex scattered_cross(std::uint64_t index, std::uint64_t seed) {
  std::uint64_t x = (index + 1) * 0x9E3779B97F4A7C15ull + seed * 0xD1B54A32D192ED03ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  x ^= x >> 31;
  return std::polar(1.0, 6.283185307179586 * static_cast<double>(x >> 11) / 9007199254740992.0);
}

void normalise_crosses(std::vector<Complex>& values, std::uint64_t seed) {
  double largest = 0;
  for (const Complex& z : values) largest = std::max(largest, std::abs(z));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double length = std::abs(values[i]);
    values[i] = length > 1e-12 * largest && std::isfinite(length) ? values[i] / length : scattered_cross(i, seed);
  }
}

double cross_energy(const CrossSystem& system, const std::vector<Complex>& z) {
  double energy = 0;
  for (int i = 0; i < system.size(); ++i)
    energy += system.diagonal[i] * std::norm(z[i]) - 2 * (std::conj(z[i]) * system.source[i]).real();
  for (const CrossLink& link : system.links) energy -= 2 * (std::conj(z[link.to]) * link.weight * z[link.from]).real();
  return energy;
}

}  // namespace hybrid_quad
