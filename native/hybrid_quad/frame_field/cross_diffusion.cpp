#include "hybrid_quad/frame_field/cross_diffusion.h"

#include <cmath>

namespace hybrid_quad {

namespace {

constexpr double kTiny = 1e-300;

/// The linear operator (diagonal + mass) - links. \returns the real part of x^H y
double apply(const CrossLevel& level, const std::vector<double>& mass, const std::vector<Complex>& x, std::vector<Complex>& y) {
  double dot = 0;
  for (int i = 0; i < level.system.size(); ++i) {
    Complex sum = (level.system.diagonal[i] + mass[i]) * x[i];
    for (int e = level.row_begin[i]; e < level.row_begin[i + 1]; ++e) sum -= times(level.weight[e], x[level.neighbour[e]]);
    y[i] = sum;
    dot += real_product(x[i], sum);
  }
  return dot;
}

}  // namespace

void diffuse_crosses(const CrossLevel& finest, const std::vector<double>& mass, std::vector<Complex>& z, const RunContext& context) {
  constexpr int kMaxIterations = 60;
  constexpr double kTolerance = 1e-4;
  const CrossSystem& system = finest.system;
  const int n = system.size();
  std::vector<Complex> residual(n), direction(n), image(n), scaled(n), x = z;
  const auto precondition = [&] {
    double dot = 0;
    for (int i = 0; i < n; ++i) {
      scaled[i] = residual[i] / (system.diagonal[i] + mass[i] + kTiny);
      dot += real_product(residual[i], scaled[i]);
    }
    return dot;
  };
  apply(finest, mass, x, image);
  for (int i = 0; i < n; ++i) residual[i] = system.source[i] + mass[i] * z[i] - image[i];
  double rho = precondition();
  const double first = rho;
  direction = scaled;
  for (int step = 0; step < kMaxIterations && rho > kTolerance * kTolerance * first && rho > kTiny; ++step) {
    if (step % 8 == 0) context.checkpoint(0.8);
    const double curvature = apply(finest, mass, direction, image);
    if (!(curvature > 0)) break;
    const double length = rho / curvature;
    for (int i = 0; i < n; ++i) {
      x[i] += length * direction[i];
      residual[i] -= length * image[i];
    }
    const double previous = rho;
    rho = precondition();
    for (int i = 0; i < n; ++i) direction[i] = scaled[i] + (rho / previous) * direction[i];
  }
  for (int i = 0; i < n; ++i) {
    const double length = std::abs(x[i]);
    if (length > 1e-12 && std::isfinite(length)) z[i] = x[i] / length;
  }
}

}  // namespace hybrid_quad
