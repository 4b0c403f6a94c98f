#include "hybrid_quad/features/rounds.h"

#include <array>
#include <cmath>

namespace hybrid_quad {

namespace {

constexpr std::size_t kFewestEdges = 8;
const double kLeastCosine = std::cos(60 * 3.14159265358979323846 / 180);  ///< of the turn at a vertex

class RoundFinder {
 public:
  RoundFinder(const TriangleMesh& mesh, const std::vector<char>& is_part, const std::vector<char>& is_other)
      : mesh_(mesh), degree_(mesh.vertex_count(), 0), at_vertex_(mesh.vertex_count(), {-1, -1}) {
    for (int h = 0; h < mesh.halfedge_count(); ++h) {
      if (mesh.opposite(h) > h) continue;  // the other side stands for the edge
      const bool is_inner = mesh.opposite(h) >= 0;
      for (const int v : {mesh.from(h), mesh.to(h)}) {
        if (!is_inner || is_other[h]) degree_[v] = kMeetsOthers;
        if (!is_inner || !is_part[h]) continue;
        if (degree_[v] < 2) at_vertex_[v][degree_[v]] = h;
        ++degree_[v];
      }
    }
  }

  Rounds run(const std::vector<char>& is_part) {
    Rounds rounds;
    rounds.of_halfedge.assign(mesh_.halfedge_count(), -1);
    std::vector<char> seen(mesh_.halfedge_count(), 0);
    for (int h = 0; h < mesh_.halfedge_count(); ++h) {
      if (!is_part[h] || mesh_.opposite(h) > h || mesh_.is_boundary(h) || seen[h]) continue;
      const bool is_round = walk(h);
      double length = 0;
      for (const int edge : path_) {
        seen[edge] = 1;
        length += mesh_.edge_length(edge);
        if (is_round) rounds.of_halfedge[edge] = rounds.of_halfedge[mesh_.opposite(edge)] = static_cast<int>(rounds.length.size());
      }
      if (is_round) rounds.length.push_back(length);
    }
    return rounds;
  }

 private:
  static constexpr int kMeetsOthers = 1 << 20;

  /// Along path_ from an edge on, until it is a round or cannot be one. \returns whether it is one
  bool walk(int first) {
    path_.assign(1, first);
    int v = mesh_.to(first);
    Vector3 direction = mesh_.edge_vector(first);
    for (;;) {
      if (degree_[v] != 2) return false;
      const int next = at_vertex_[v][at_vertex_[v][0] == path_.back() ? 1 : 0];
      const bool is_forward = mesh_.from(next) == v;
      const Vector3 onward = (is_forward ? 1.0 : -1.0) * mesh_.edge_vector(next);
      if (direction.dot(onward) < kLeastCosine * direction.norm() * onward.norm()) return false;
      if (next == first) return path_.size() >= kFewestEdges;
      path_.push_back(next);
      direction = onward;
      v = is_forward ? mesh_.to(next) : mesh_.from(next);
    }
  }

  const TriangleMesh& mesh_;
  std::vector<int> degree_;                    // by vertex
  std::vector<std::array<int, 2>> at_vertex_;  // edges of rounds there, as half-edges that stand for them
  std::vector<int> path_;
};

}  // namespace

Rounds find_rounds(const TriangleMesh& mesh, const std::vector<char>& is_part, const std::vector<char>& is_other) {
  return RoundFinder(mesh, is_part, is_other).run(is_part);
}

}  // namespace hybrid_quad
