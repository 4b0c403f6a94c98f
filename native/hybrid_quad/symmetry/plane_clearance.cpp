#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

namespace {

class Clearance {
 public:
  Clearance(QuadMesh& mesh, PlaneSet planes) : mesh_(mesh), planes_(planes), quads_at_(mesh.positions.size()) {
    for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
      for (const int v : mesh.quads[q]) quads_at_[v].push_back(q);
  }

  /// \return whether v was too near to a plane
  bool clear(int v) {
    constexpr double kTouches = 1e-3;  // of the sides around
    constexpr double kPushes[] = {0.02, 0.05, 0.1, 0.2}, kTowardsMiddle[] = {0, 0.25, 0.5, 1};
    if (mesh_.kind[v] != VertexKind::kFree || quads_at_[v].empty()) return false;
    const auto [middle, side] = around(v);
    if (!touches(mesh_.positions[v], kTouches * side)) return false;
    // Of some places in front of the plane, the one where the worst quad is best.
    const Vector3 old = mesh_.positions[v];
    Vector3 best = old;
    double best_quality = -std::numeric_limits<double>::infinity();
    for (const double part : kTowardsMiddle)
      for (const double push : kPushes) {
        Vector3 p = old + part * (middle - old);
        for (int axis = 0; axis < 3; ++axis)
          if (has_plane(planes_, axis)) p[axis] = std::max(p[axis], push * side);
        mesh_.positions[v] = p;
        const double quality = worst_at(v);
        if (quality <= best_quality) continue;
        best = p;
        best_quality = quality;
      }
    mesh_.positions[v] = best;
    return true;
  }

 private:
  bool touches(const Vector3& p, double distance) const {
    for (int axis = 0; axis < 3; ++axis)
      if (has_plane(planes_, axis) && p[axis] <= distance) return true;
    return false;
  }

  /// The mean of v's neighbours, and its mean distance to them.
  std::pair<Vector3, double> around(int v) const {
    Vector3 sum = Vector3::Zero();
    double side = 0;
    for (const int q : quads_at_[v])
      for (int i = 0; i < 4; ++i) {
        if (mesh_.quads[q][i] != v) continue;
        for (const int w : {mesh_.quads[q][(i + 1) & 3], mesh_.quads[q][(i + 3) & 3]}) {
          sum += mesh_.positions[w];
          side += (mesh_.positions[w] - mesh_.positions[v]).norm();
        }
      }
    const double count = 2.0 * static_cast<double>(quads_at_[v].size());
    return {sum / count, side / count};
  }

  double worst_at(int v) const {
    double worst = 1;
    for (const int q : quads_at_[v]) {
      const auto& c = mesh_.quads[q];
      const auto& p = mesh_.positions;
      worst = std::min(worst, scaled_jacobian(p[c[0]], p[c[1]], p[c[2]], p[c[3]]));
    }
    return worst;
  }

  QuadMesh& mesh_;
  PlaneSet planes_;
  std::vector<std::vector<int>> quads_at_;
};

}  // namespace

int keep_clear_of_planes(QuadMesh& mesh, PlaneSet planes) {
  if (planes == 0) return 0;
  Clearance clearance(mesh, planes);
  int moved = 0;
  for (int v = 0; v < static_cast<int>(mesh.positions.size()); ++v) moved += clearance.clear(v);
  return moved;
}

}  // namespace hybrid_quad
