#pragma once

#include <vector>

#include "hybrid_quad/frame_field/frame_field.h"

namespace hybrid_quad {

/// The factor by which to lengthen the target length in every face so that the turning of the unit field becomes the
/// gradient of its size: grad(log length) = -J grad(angle), in the least-squares sense, one Poisson problem on vertices.
/// \param clip  bound of the factor around its mean, both ways (> 1)
std::vector<double> conformal_length_factor(const WorkingSurface& surface, const FrameField& field, double clip,
                                            const RunContext& context);

}  // namespace hybrid_quad
