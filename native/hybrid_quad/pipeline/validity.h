#pragma once

#include <string>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/topology.h"

namespace hybrid_quad {

/// \throws InternalError with the first of a stage's violations
template <class Violations>
void require_sound(const std::string& stage, const Violations& violations) {
  if (!violations.empty()) throw InternalError(stage, violations.front());
}

/// An indexed mesh can hold the quads, and has the surface's topology there too. \throws InternalError
inline void require_valid(const std::string& stage, const QuadMesh& mesh, const Topology& topology) {
  require_sound(stage, violations_of(mesh));
  if (topology_of(mesh) != topology) throw InternalError(stage, "the quads, by their vertices, have another topology than the surface");
}

}  // namespace hybrid_quad
