#include "hybrid_quad/singular_patches/discrete_gradient.h"

namespace hybrid_quad {

void fan_of(const TriangleMesh& mesh, int v, std::vector<int>& halfedges) {
  halfedges.clear();
  const int first = mesh.outgoing(v);
  for (int h = first; h >= 0;) {
    halfedges.push_back(h);
    const int n = mesh.rotate_ccw(h);
    if (n < 0) halfedges.push_back(TriangleMesh::previous(h));
    h = n == first ? -1 : n;
  }
}

namespace {

/// Pairs the cells of one lower star. Its link is a set of chains (or the whole circle): in the first chain
/// one edge is paired with the vertex, in every other one is critical, and from there each next edge is
/// paired with the face before it.
class LowerStar {
 public:
  LowerStar(const TriangleMesh& mesh, const std::vector<int>& rank, DiscreteGradient& gradient)
      : mesh_(mesh), rank_(rank), gradient_(gradient) {}

  void pair(int v, int forced) {
    fan_of(mesh_, v, fan_);
    const int count = static_cast<int>(fan_.size());
    closed_ = !mesh_.is_boundary_vertex(v);
    lower_.assign(count, 0);
    int left = 0;
    for (int i = 0; i < count; ++i) {
      lower_[i] = rank_[far_end(v, i)] < rank_[v];
      left += lower_[i];
    }
    circle_ = closed_ && left == count;
    for (bool first = true; left > 0; first = false) {
      int start = -1;
      for (int i = 0; i < count; ++i)
        if (lower_[i] && (start < 0 || rank_[far_end(v, i)] < rank_[far_end(v, start)])) start = i;
      if (first && forced >= 0)
        for (int i = 0; i < count; ++i)
          if (lower_[i] && same_edge(fan_[i], forced)) start = i;
      if (first)
        gradient_.down[v] = fan_[start];
      else
        gradient_.critical_edges.push_back(DiscreteGradient::edge_of(mesh_, fan_[start]));
      left -= spread(start);
    }
  }

 private:
  int far_end(int v, int i) const {
    return mesh_.from(fan_[i]) == v ? mesh_.to(fan_[i]) : mesh_.from(fan_[i]);
  }
  bool same_edge(int g, int h) const { return g == h || (mesh_.opposite(g) == h); }

  /// Pairs the chain of edge `start` and takes it out of the star. \return edges taken
  int spread(int start) {
    const int count = static_cast<int>(fan_.size());
    lower_[start] = 0;
    int taken = 1;
    for (int i = start;;) {  // counterclockwise: edge j closes the face that starts at edge i
      const int j = i + 1 < count ? i + 1 : (closed_ ? 0 : -1);
      if (j < 0 || !lower_[j]) break;
      gradient_.up[mesh_.face_of(fan_[i])] = TriangleMesh::previous(fan_[i]);
      lower_[j] = 0;
      ++taken;
      i = j;
    }
    if (circle_) return taken;  // the face between the last edge and the first stays critical: a maximum
    for (int i = start;;) {     // clockwise: edge j opens the face that edge i closes
      const int j = i > 0 ? i - 1 : (closed_ ? count - 1 : -1);
      if (j < 0 || !lower_[j]) break;
      gradient_.up[mesh_.face_of(fan_[j])] = fan_[j];
      lower_[j] = 0;
      ++taken;
      i = j;
    }
    return taken;
  }

  const TriangleMesh& mesh_;
  const std::vector<int>& rank_;
  DiscreteGradient& gradient_;
  std::vector<int> fan_;
  std::vector<char> lower_;
  bool closed_ = false, circle_ = false;
};

}  // namespace

DiscreteGradient discrete_gradient(const TriangleMesh& mesh, const std::vector<int>& rank,
                                   const std::vector<int>& forced_descent) {
  DiscreteGradient gradient;
  gradient.down.assign(mesh.vertex_count(), -1);
  gradient.up.assign(mesh.face_count(), -1);
  LowerStar star(mesh, rank, gradient);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.outgoing(v) >= 0) star.pair(v, forced_descent[v]);
  return gradient;
}

}  // namespace hybrid_quad
