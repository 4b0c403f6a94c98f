#pragma once

#include <vector>

#include "hybrid_quad/frame_field/surface_curvature.h"
#include "hybrid_quad/sizing/feature_size.h"

namespace hybrid_quad {

/// How strongly a density may vary: edges this many times shorter, or longer, than the usual one.
constexpr double kMostDensity = 10, kLeastDensity = 0.1;

/// Density (usual edge length over the asked one) that follows the surface's curvature: edges as long as a chord that
/// leaves the surface by a fixed height, h = sqrt(8 height / curvature), within 1/3 to 2 times the usual length. The
/// height is the one that keeps the number of quads.
/// \param surface  of even size `length`
/// \param adaptivity  0: even, 1: as above; between them the lengths' logarithms are blended
/// \return #V of `mesh`, which `surface` was made of
std::vector<double> curvature_density(const WorkingSurface& surface, const TriangleMesh& mesh, double length, double adaptivity,
                                      const RunContext& context);

/// The least density above the given one for which lengths, length / density, grow by at most `growth` over a unit of distance.
/// \param density  #V, changed
void grade_density(const TriangleMesh& mesh, double length, double growth, std::vector<double>& density, const RunContext& context);

/// Integral of density^2: the area at density 1 that asks for as many quads. \param density #V; empty: 1 everywhere
double area_by_density(const TriangleMesh& mesh, const std::vector<double>& density);

/// The longest length / density. \param density  #V, or empty: 1
double longest_asked(double length, const std::vector<double>& density);

/// feature_sized_lengths() around lengths that vary already: length / density. \param density  #V, or empty: 1
/// \param thin  thin_places() for the longest of them
std::vector<double> asked_lengths(const SurfaceIndex& index, const FeatureGraph& features, double length,
                                  const std::vector<double>& density, const std::vector<ThinPlace>& thin,
                                  const FeatureSizeOptions& options, const RunContext& context);

}  // namespace hybrid_quad
