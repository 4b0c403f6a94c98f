#include "hybrid_quad/frame_field/move_cones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "hybrid_quad/frame_field/frame_topology.h"

namespace hybrid_quad {

namespace {

constexpr double kEighth = 0.78539816339744831;  // pi / 4: the turn beyond which a frame's axes are renamed
constexpr double kMargin = 0.02;                 // how far beyond it a frame is turned (radians)

bool is_free_face(const WorkingSurface& surface, int f) {
  for (int h = 3 * f; h < 3 * f + 3; ++h)
    if (surface.mesh.is_boundary(h) || surface.features.is_feature(h)) return false;
  return true;
}

class ConeMover {
 public:
  ConeMover(const WorkingSurface& surface, const FaceAngles& angles, std::vector<double>& directions)
      : surface_(surface), mesh_(surface.mesh), angles_(angles), directions_(directions) {}

  bool is_free_vertex(int v) const {
    return mesh_.outgoing(v) >= 0 && !surface_.features.on_feature[v] && !mesh_.is_boundary_vertex(v);
  }

  int quarters(int v) const { return quarters_at(mesh_, angles_, directions_, v); }

  /// Moves one quarter from v along the edge whose frames turn most already. \return false if no edge lets it pass
  bool split(int v) {
    return move_quarter(v, [](int, double) { return true; });
  }

  /// Likewise, to a neighbour that has the opposite index.
  bool cancel(int v) {
    const int index = quarters(v);
    return move_quarter(v, [&](int to, double turn) { return turn > 0 && quarters(to) == -index; });
  }

 private:
  /// \param takes  whether it may go to a neighbour, and across an edge that already turns so far
  template <class Takes>
  bool move_quarter(int v, const Takes& takes) {
    const int sign = quarters(v) > 0 ? 1 : -1;
    std::vector<std::pair<double, int>> candidates;
    const int first = mesh_.outgoing(v);
    int h = first;
    do {
      // Counterclockwise around v one passes from the right side of an outgoing edge to its left.
      const double turn = sign * unexpected_turn(mesh_.opposite(h));
      if (is_free_vertex(mesh_.to(h)) && takes(mesh_.to(h), turn)) candidates.push_back({-turn, h});
      h = mesh_.rotate_ccw(h);
    } while (h != first);
    std::sort(candidates.begin(), candidates.end());
    for (const auto& candidate : candidates)
      if (turn_frames(candidate.second, sign, kEighth + kMargin + candidate.first)) return true;
    return false;
  }

  /// Axes are renamed where this is more than an eighth.
  double unexpected_turn(int h) const { return turn_across(mesh_, angles_, directions_, h).angle - angles_.expected_turn(h); }

  int badness(const std::array<int, 4>& vertices) const {
    int sum = 0;
    for (const int v : vertices)
      if (is_free_vertex(v)) sum += quarters(v) * quarters(v);
    return sum;
  }

  /// Turns the frames on both sides of h apart by `needed`; undone if that makes no index smaller.
  bool turn_frames(int h, int sign, double needed) {
    const int o = mesh_.opposite(h), left = h / 3, right = o / 3;
    const bool left_free = is_free_face(surface_, left), right_free = is_free_face(surface_, right);
    if (left == right || (!left_free && !right_free)) return false;
    const double left_share = left_free ? (right_free ? 0.5 : 1.0) : 0.0;
    const std::array<int, 4> touched{mesh_.from(h), mesh_.to(h), mesh_.to(TriangleMesh::next(h)), mesh_.to(TriangleMesh::next(o))};
    const double old_left = directions_[left], old_right = directions_[right];
    const int before = badness(touched);
    directions_[left] += sign * left_share * needed;
    directions_[right] -= sign * (1 - left_share) * needed;
    if (badness(touched) < before) return true;
    directions_[left] = old_left;
    directions_[right] = old_right;
    return false;
  }

  const WorkingSurface& surface_;
  const TriangleMesh& mesh_;
  const FaceAngles& angles_;
  std::vector<double>& directions_;
};

}  // namespace

int split_strong_cones(const WorkingSurface& surface, const FaceAngles& angles, std::vector<double>& directions) {
  ConeMover mover(surface, angles, directions);
  int left = 0;
  for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
    if (!mover.is_free_vertex(v)) continue;
    while (std::abs(mover.quarters(v)) > 1)
      if (!mover.split(v)) {
        ++left;
        break;
      }
  }
  return left;
}

int cancel_cones(const WorkingSurface& surface, const FaceAngles& angles, std::vector<double>& directions) {
  ConeMover mover(surface, angles, directions);
  int cancelled = 0;
  for (int v = 0; v < surface.mesh.vertex_count(); ++v)
    if (mover.is_free_vertex(v) && mover.quarters(v) != 0) cancelled += mover.cancel(v);
  return cancelled;
}

}  // namespace hybrid_quad
