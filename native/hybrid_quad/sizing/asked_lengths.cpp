#include "hybrid_quad/sizing/asked_lengths.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hybrid_quad {

namespace {

/// The density for chords of one height on faces of given curvature: (curvature / k)^(1/2), bounded, where k makes the
/// integral of its square the area.
class ChordDensity {
 public:
  ChordDensity(const TriangleMesh& mesh, const std::vector<PrincipalCurvature>& curvature) {
    for (int f = 0; f < mesh.face_count(); ++f) samples_.push_back({mesh.area(f), std::abs(curvature[f].strong)});
    double low = 1e-300, high = 0, total = 0;
    for (const Sample& s : samples_) {
      high = std::max(high, s.curvature);
      total += s.area;
    }
    if (!(high > 0)) return;
    // The integral falls from the largest density's to the smallest's as k grows; in logarithms, k may be anything.
    high *= 1 / (kLeast * kLeast);
    constexpr int kHalvings = 200;
    for (int step = 0; step < kHalvings; ++step) {
      k_ = std::sqrt(low) * std::sqrt(high);
      (integral() > total ? low : high) = k_;
    }
  }

  double at(double curvature) const {
    return k_ > 0 ? std::clamp(std::sqrt(curvature / k_), kLeast, kMost) : 1.0;
  }

 private:
  static constexpr double kLeast = 1 / 2.0, kMost = 3;
  struct Sample {
    double area, curvature;
  };

  double integral() const {
    double sum = 0;
    for (const Sample& s : samples_) sum += s.area * at(s.curvature) * at(s.curvature);
    return sum;
  }

  std::vector<Sample> samples_;
  double k_ = 0;
};

/// Averages over neighbouring faces, about 1.6 quad edges to either side: bumps of the density cost irregular vertices.
void smooth_over_faces(const TriangleMesh& mesh, std::vector<double>& value) {
  constexpr int kSteps = 60;
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<double> before = value;
    for (int f = 0; f < mesh.face_count(); ++f) {
      double sum = before[f];
      int count = 1;
      for (int h = 3 * f; h < 3 * f + 3; ++h)
        if (mesh.opposite(h) >= 0) {
          sum += before[mesh.opposite(h) / 3];
          ++count;
        }
      value[f] = sum / count;
    }
  }
}

}  // namespace

std::vector<double> curvature_density(const WorkingSurface& surface, const TriangleMesh& mesh, double length, double adaptivity,
                                      const RunContext& context) {
  constexpr double kGrowth = 0.3;
  const std::vector<PrincipalCurvature> curvature = principal_curvatures(surface);
  const ChordDensity chord(surface.mesh, curvature);
  std::vector<double> log_density(curvature.size());
  for (std::size_t f = 0; f < curvature.size(); ++f) log_density[f] = adaptivity * std::log(chord.at(std::abs(curvature[f].strong)));
  smooth_over_faces(surface.mesh, log_density);
  const SurfaceIndex index(surface.mesh, {});
  std::vector<double> density(mesh.vertex_count(), 1.0);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int face = index.nearest(mesh.position(v)).face;
    if (face >= 0) density[v] = std::exp(log_density[face]);
  }
  grade_density(mesh, length, kGrowth, density, context);
  return density;
}

void grade_density(const TriangleMesh& mesh, double length, double growth, std::vector<double>& density, const RunContext& context) {
  std::vector<double> asked(density.size());
  std::transform(density.begin(), density.end(), asked.begin(), [length](double d) { return length / d; });
  grade_lengths(mesh, std::numeric_limits<double>::infinity(), asked, growth, context);
  for (std::size_t v = 0; v < density.size(); ++v) density[v] = std::max(density[v], length / asked[v]);
}

double area_by_density(const TriangleMesh& mesh, const std::vector<double>& density) {
  if (density.empty()) return mesh.total_area();
  std::vector<double> length(density.size());
  std::transform(density.begin(), density.end(), length.begin(), [](double d) { return 1 / d; });
  return quads_for_lengths(mesh, length);
}

double longest_asked(double length, const std::vector<double>& density) {
  return density.empty() ? length : length / *std::min_element(density.begin(), density.end());
}

std::vector<double> asked_lengths(const SurfaceIndex& index, const FeatureGraph& features, double length,
                                  const std::vector<double>& density, const std::vector<ThinPlace>& thin,
                                  const FeatureSizeOptions& options, const RunContext& context) {
  if (density.empty()) return feature_sized_lengths(index, features, length, thin, options, context);
  const TriangleMesh& mesh = index.mesh();
  // Features make room as they would among quads of the longest edges; what is shorter already has its room.
  const double longest = longest_asked(length, density);
  FeatureSizeOptions relative = options;
  relative.least_ratio *= length / longest;
  relative.thin_ratio *= length / longest;
  std::vector<double> target = feature_sized_lengths(index, features, longest, thin, relative, context);
  for (int v = 0; v < mesh.vertex_count(); ++v) target[v] = std::min(target[v], length / density[v]);
  return target;
}

}  // namespace hybrid_quad
