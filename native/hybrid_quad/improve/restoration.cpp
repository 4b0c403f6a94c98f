#include "hybrid_quad/improve/restoration.h"

#include <algorithm>

#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

double reach_of(const QuadMesh& mesh, int q, const Vector3& centre) {
  double reach = 0;
  for (const int v : mesh.quads[q]) reach = std::max(reach, (mesh.positions[v] - centre).norm());
  return reach;
}

}  // namespace

Restoration::Restoration(const QuadMesh& extracted, const SurfaceIndex& index, const Agreement& agreement, int threads)
    : locked_(extracted.quads.size(), 0), flawed_(extracted.quads.size(), 0) {
  for (const int q : flawed_quads(extracted, index, agreement, threads)) {
    flawed_[q] = 1;
    ++flawed_count_;
  }
  for (int q = 0; q < static_cast<int>(extracted.quads.size()); ++q) {
    centre_.push_back(middle_of(extracted, q));
    reach_.push_back(reach_of(extracted, q, centre_.back()));
    mean_edge_ += reach_.back() * 1.4142135623730951 / static_cast<double>(extracted.quads.size());
  }
}

int Restoration::locked_count() const { return static_cast<int>(std::count(locked_.begin(), locked_.end(), 1)); }

bool Restoration::give_up_around(const QuadMesh& improved, const std::vector<int>& flawed) {
  const double margin = 0.5 * mean_edge_ * rounds_;
  ++rounds_;
  bool any = false;
  for (const int f : flawed) {
    const Vector3 centre = middle_of(improved, f);
    const double radius = reach_of(improved, f, centre) + margin;
    std::vector<int> near;
    bool hopeless = false;
    for (int q = 0; q < static_cast<int>(centre_.size()); ++q) {
      if ((centre_[q] - centre).norm() > radius + reach_[q]) continue;
      near.push_back(q);
      hopeless |= flawed_[q] != 0;
    }
    if (hopeless) continue;
    for (const int q : near) {
      any |= !locked_[q];
      locked_[q] = 1;
    }
  }
  return any;
}

bool Restoration::give_up_at(const QuadMesh& extracted, const std::vector<int>& vertices) {
  std::vector<char> is_given_up(extracted.positions.size(), 0);
  for (const int v : vertices) is_given_up[v] = 1;
  bool any = false;
  for (std::size_t q = 0; q < extracted.quads.size(); ++q) {
    const auto& corners = extracted.quads[q];
    if (flawed_[q] || locked_[q] || std::none_of(corners.begin(), corners.end(), [&](int v) { return is_given_up[v] != 0; }))
      continue;
    locked_[q] = 1;
    any = true;
  }
  return any;
}

}  // namespace hybrid_quad
