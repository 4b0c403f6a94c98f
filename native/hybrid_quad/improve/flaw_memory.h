#pragma once

#include <array>
#include <cstring>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

/// flawed_quads, which remembers quads by their corners: from one trial to the next nearly all stay where they are.
class FlawMemory {
 public:
  /// \param edge  mean edge length: the unit of what counts as area
  FlawMemory(const SurfaceIndex& surface, const Agreement& agreement, double edge)
      : surface_(surface), agreement_(agreement), least_area_(kLeastArea * edge * edge) {}

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
    if (is_new) known->second = hybrid_quad::is_flawed(known->first, least_area_, surface_, agreement_);
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
  std::unordered_map<std::array<Vector3, 4>, bool, Hash> known_;
};

}  // namespace hybrid_quad
