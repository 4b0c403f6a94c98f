#pragma once

#include "hybrid_quad/features/features.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/sizing/thin_parts.h"

namespace hybrid_quad {

/// A place where quads must be short, whatever is asked.
struct LengthLimit {
  Vector3 position;
  double length;  ///< scene units
};

struct FeatureSizeOptions {
  double least_ratio = 0.35;   ///< shortest length over the asked one
  double thin_ratio = 0.35;    ///< the same in thin tubes and tips
  double growth = 0.5;         ///< how much the length may grow over a unit of distance
};

/// Target lengths that give way to small features: near a curve that is shorter than a quad edge, and where two curves
/// that do not meet are nearer than one, the length is that of the curve or of the gap (within bounds); where curves bend
/// within an edge it follows the bend; thin tubes and tips get at least four quads around. The length grows back with the distance.
/// \param index  of the surface
/// \param length  asked quad edge length (scene units)
/// \param thin  thin_places() for that length
/// \returns #V of the mesh
std::vector<double> feature_sized_lengths(const SurfaceIndex& index, const FeatureGraph& features, double length,
                                          const std::vector<ThinPlace>& thin, const FeatureSizeOptions& options,
                                          const RunContext& context);

/// Shortens lengths (#V) that are longer than they may be somewhere near; grade_lengths spreads that.
void limit_lengths(const SurfaceIndex& index, const std::vector<LengthLimit>& limits, std::vector<double>& length);

/// Lets lengths (#V) of up to `longest` grow no faster than that with the distance.
void grade_lengths(const TriangleMesh& mesh, double longest, std::vector<double>& length, double growth, const RunContext& context);

/// Number of quads that fit: integral of 1 / h^2 (h is linear in each face; one point a face).
double quads_for_lengths(const TriangleMesh& mesh, const std::vector<double>& length);

}  // namespace hybrid_quad
