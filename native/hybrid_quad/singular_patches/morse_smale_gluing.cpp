#include "hybrid_quad/singular_patches/morse_smale_gluing.h"

#include <algorithm>

namespace hybrid_quad {

namespace {

/// Maxima by faces: every face flows, over the edge it is paired with, to a critical face or out of the
/// border.
class Ascent {
 public:
  Ascent(const TriangleMesh& mesh, const PatchBorder& border, const std::vector<int>& rank,
         const DiscreteGradient& gradient)
      : mesh_(mesh),
        rank_(rank),
        gradient_(gradient),
        border_top_(mesh.halfedge_count(), -1),
        top_(mesh.face_count(), -1) {
    for (const auto& loop : border)
      for (const PatchArc& arc : loop)
        for (const int h : arc.halfedges) border_top_[h] = arc.rising ? arc.to : arc.from;
  }

  /// The maximum reached from the left side of half-edge h.
  int from_side(int h) {
    int f = mesh_.face_of(h);
    path_.clear();
    while (top_[f] < 0) {
      path_.push_back(f);
      const int exit = gradient_.up[f];
      if (exit < 0) {
        const auto& t = mesh_.face(f);
        top_[f] = *std::max_element(t.begin(), t.end(), [&](int a, int b) { return rank_[a] < rank_[b]; });
      } else if (mesh_.is_boundary(exit)) {
        top_[f] = border_top_[exit];
      } else {
        f = mesh_.face_of(mesh_.opposite(exit));
      }
    }
    for (const int g : path_) top_[g] = top_[f];
    return top_[f];
  }

 private:
  const TriangleMesh& mesh_;
  const std::vector<int>& rank_;
  const DiscreteGradient& gradient_;
  std::vector<int> border_top_, top_, path_;
};

/// Walks around the trees of descending paths.
class DescentTrees {
 public:
  DescentTrees(const TriangleMesh& mesh, const DiscreteGradient& gradient)
      : mesh_(mesh), gradient_(gradient), saddle_of_edge_(mesh.halfedge_count(), -1) {
    for (std::size_t c = 0; c < gradient.critical_edges.size(); ++c)
      saddle_of_edge_[gradient.critical_edges[c]] = static_cast<int>(c);
  }

  /// The corners (darts of the quads) at a minimum, counterclockwise; from the first border edge to the last
  /// where it is on the border.
  const std::vector<int>& corners_at(int minimum) {
    corners_.clear();
    pending_.assign(1, {minimum, -1});
    while (!pending_.empty()) {
      const Item item = pending_.back();
      pending_.pop_back();
      if (item.dart >= 0)
        corners_.push_back(item.dart);
      else
        expand(item.vertex);
    }
    return corners_;
  }

 private:
  struct Item {
    int vertex;  ///< of the tree, its branches not yet walked
    int dart;    ///< or a corner found
  };

  void expand(int v) {
    fan_of(mesh_, v, fan_);
    const int count = static_cast<int>(fan_.size());
    const int parent = gradient_.down[v] < 0 ? -1 : DiscreteGradient::edge_of(mesh_, gradient_.down[v]);
    int start = 0;
    for (int i = 0; i < count; ++i)
      if (DiscreteGradient::edge_of(mesh_, fan_[i]) == parent) start = i + 1;
    for (int k = count - 1; k >= 0; --k) {  // a stack: last branch first
      const int h = fan_[(start + k) % count], e = DiscreteGradient::edge_of(mesh_, h);
      if (e == parent) continue;
      const int w = mesh_.from(h) == v ? mesh_.to(h) : mesh_.from(h);
      const int saddle = saddle_of_edge_[e];
      if (saddle >= 0)
        pending_.push_back({-1, 4 * saddle + (mesh_.from(e) == v ? 0 : 2)});
      else if (gradient_.down[w] >= 0 && DiscreteGradient::edge_of(mesh_, gradient_.down[w]) == e)
        pending_.push_back({w, -1});
    }
  }

  const TriangleMesh& mesh_;
  const DiscreteGradient& gradient_;
  std::vector<int> saddle_of_edge_, fan_, corners_;
  std::vector<Item> pending_;
};

int add_vertex(MorseSmaleComplex& result, const PatchSurface& patch, int v) {
  QuadComplex& quads = result.quads;
  const bool on_border = patch.mesh.is_boundary_vertex(v) && patch.node[v] >= 0;
  result.extremum.push_back(v);
  quads.positions.push_back(patch.mesh.position(v));
  quads.kind.push_back(on_border ? VertexKind::kCorner : VertexKind::kFree);
  quads.anchor.push_back(on_border ? patch.node[v] : -1);
  quads.near_face.push_back(-1);
  return static_cast<int>(result.extremum.size()) - 1;
}

/// Glues the sides left and right of the paths that arrive at minimum m, in order.
void glue_at_minimum(MorseSmaleComplex& result, const PatchSurface& patch, int m,
                     const std::vector<int>& corners) {
  if (corners.empty()) return;
  QuadComplex& quads = result.quads;
  const int vertex = add_vertex(result, patch, m);
  const bool on_border = patch.mesh.is_boundary_vertex(m);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    quads.vertex[corners[i]] = vertex;
    if (i + 1 == corners.size() && on_border) break;
    const int left = QuadComplex::previous(corners[i]), right = corners[(i + 1) % corners.size()];
    quads.opposite[left] = right;
    quads.opposite[right] = left;
  }
  if (!on_border) return;
  std::vector<int> fan;
  fan_of(patch.mesh, m, fan);
  quads.curve[corners.front()] = patch.boundary_arc[fan.front()];
  quads.curve[QuadComplex::previous(corners.back())] = patch.boundary_arc[fan.back()];
}

/// Names the orbits of corners 1 and 3 after the maxima that the saddles' ascending paths reach.
void name_maxima(MorseSmaleComplex& result, const PatchSurface& patch, const std::vector<int>& reached) {
  QuadComplex& quads = result.quads;
  const std::vector<int> orbit = vertex_orbits(quads.opposite);
  std::vector<int> vertex_of(orbit.size(), -1), number(patch.mesh.vertex_count(), -1);
  for (int d = 0; d < static_cast<int>(orbit.size()); ++d) {
    if (d % 2 == 0) continue;
    const int maximum = reached[d / 2];
    int& vertex = vertex_of[orbit[d]];
    if (vertex < 0) {
      if (number[maximum] >= 0) throw InternalError("morse-smale", "a maximum has two fans of quads");
      vertex = number[maximum] = add_vertex(result, patch, maximum);
    }
    if (result.extremum[vertex] != maximum)
      throw InternalError("morse-smale", "ascending paths of one fan end at two maxima");
    quads.vertex[d] = vertex;
  }
}

}  // namespace

MorseSmaleComplex morse_smale_complex(const PatchSurface& patch, const PatchBorder& border,
                                      const std::vector<int>& rank, const DiscreteGradient& gradient,
                                      const RunContext& context) {
  const TriangleMesh& mesh = patch.mesh;
  MorseSmaleComplex result;
  const std::size_t darts = 4 * gradient.critical_edges.size();
  result.quads.opposite.assign(darts, -1);
  result.quads.vertex.assign(darts, -1);
  result.quads.curve.assign(darts, -1);

  DescentTrees trees(mesh, gradient);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (v % 65536 == 0) context.checkpoint();
    if (gradient.down[v] < 0 && mesh.outgoing(v) >= 0) glue_at_minimum(result, patch, v, trees.corners_at(v));
  }
  for (std::size_t d = 0; d < darts; d += 2)
    if (result.quads.vertex[d] < 0)
      throw InternalError("morse-smale", "a descending path ends at no minimum");

  Ascent ascent(mesh, border, rank, gradient);
  std::vector<int> reached;  // by odd corner
  for (const int e : gradient.critical_edges) {
    if (mesh.is_boundary(e)) throw InternalError("morse-smale", "a saddle lies on the border");
    reached.push_back(ascent.from_side(mesh.opposite(e)));
    reached.push_back(ascent.from_side(e));
    result.saddle.push_back(rank[mesh.from(e)] > rank[mesh.to(e)] ? patch.morse[mesh.from(e)]
                                                                  : patch.morse[mesh.to(e)]);
  }
  name_maxima(result, patch, reached);
  return result;
}

}  // namespace hybrid_quad
