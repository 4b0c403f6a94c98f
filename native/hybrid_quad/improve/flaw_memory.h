#pragma once

#include <array>
#include <cstring>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

/// Nearly or really concave, or a triangle, whatever the surface is like. More than nothing, as files round.
inline bool is_folded(const std::array<Vector3, 4>& corners) {
  constexpr double kLeastShape = 0.01;  // scaled Jacobian
  return scaled_jacobian(corners[0], corners[1], corners[2], corners[3]) <= kLeastShape;
}

/// flawed_quads, which remembers quads by their corners: from one trial to the next nearly all stay where they are.
class FlawMemory {
 public:
  /// \param edge  mean edge length: the unit of what counts as area
  /// \param and_folded  folded quads (is_folded) count as well
  FlawMemory(const SurfaceIndex& surface, const Agreement& agreement, double edge, bool and_folded = false)
      : surface_(surface), agreement_(agreement), least_area_(kLeastArea * edge * edge), and_folded_(and_folded) {}

  /// Ascending.
  std::vector<int> flawed_of(const QuadMesh& mesh) {
    std::vector<int> flawed;
    for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
      if (is_flawed(mesh, q)) flawed.push_back(q);
    return flawed;
  }

  bool is_flawed(const QuadMesh& mesh, int q) {
    const auto& v = mesh.quads[q];
    const auto& p = mesh.positions;
    const auto [known, is_new] = known_.try_emplace({p[v[0]], p[v[1]], p[v[2]], p[v[3]]}, false);
    if (is_new) known->second = (and_folded_ && is_folded(known->first)) || hybrid_quad::is_flawed(known->first, least_area_, surface_, agreement_);
    return known->second;
  }

 private:
  static constexpr double kLeastArea = 1e-10;
  struct Hash {
    std::size_t operator()(const std::array<Vector3, 4>& corners) const {
      char bytes[sizeof(corners)];
      std::memcpy(bytes, corners.data(), sizeof(corners));
      return std::hash<std::string_view>()({bytes, sizeof(bytes)});
    }
  };

  const SurfaceIndex& surface_;
  Agreement agreement_;
  double least_area_;
  bool and_folded_;
  std::unordered_map<std::array<Vector3, 4>, bool, Hash> known_;
};

}  // namespace hybrid_quad
