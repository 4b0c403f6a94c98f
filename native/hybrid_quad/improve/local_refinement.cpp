#include "hybrid_quad/improve/local_refinement.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "hybrid_quad/improve/side_splitting.h"

namespace hybrid_quad {

namespace {

/// One quad's part of it. Corners are 0 to 3, the vertices on side i are 4 + 2 i and 5 + 2 i, counterclockwise, those inside 12 to
/// 15, each near its corner.
struct Template {
  std::array<int, 4> sides;  ///< 1 if split; other quads are turned until theirs are these
  std::vector<std::array<int, 4>> quads;
};

/// For two sides beside each other and three, as in 3-refinement (Schneiders, *Refining quadrilateral and hexahedral element
/// meshes*, 1996): vertices on split sides get an edge inwards, the corners of others none.
const std::vector<Template>& templates() {
  static const std::vector<Template> kAll{
      {{0, 0, 0, 0}, {{0, 1, 2, 3}}},
      {{1, 0, 0, 0}, {{0, 4, 12, 3}, {4, 5, 13, 12}, {5, 1, 2, 13}, {12, 13, 2, 3}}},
      {{1, 0, 1, 0}, {{0, 4, 9, 3}, {4, 5, 8, 9}, {5, 1, 2, 8}}},
      {{1, 1, 0, 0}, {{5, 1, 6, 13}, {4, 5, 13, 12}, {0, 4, 12, 3}, {13, 6, 7, 14}, {14, 7, 2, 3}, {12, 13, 14, 3}}},
      {{1, 1, 1, 0},
       {{5, 1, 6, 13}, {13, 6, 7, 14}, {14, 7, 2, 8}, {4, 5, 13, 12}, {12, 13, 14, 15}, {15, 14, 8, 9}, {0, 4, 12, 15}, {0, 15, 9, 3}}},
      {{1, 1, 1, 1},
       {{0, 4, 12, 11}, {4, 5, 13, 12}, {5, 1, 6, 13}, {13, 6, 7, 14}, {14, 7, 2, 8}, {15, 14, 8, 9}, {10, 15, 9, 3}, {11, 12, 15, 10},
        {12, 13, 14, 15}}}};
  return kAll;
}

class LocalRefiner {
 public:
  LocalRefiner(const QuadMesh& mesh, const Workpiece& piece, const std::vector<char>& chosen, std::vector<int>* touched)
      : mesh_(mesh), piece_(piece), chosen_(chosen), touched_(*touched), out_(mesh) {}

  QuadMesh run() {
    for (const QuadMesh::FeatureEdge& edge : mesh_.feature_edges) feature_edges_[key_of(edge.a, edge.b)] = edge;
    for (int q = 0; q < static_cast<int>(mesh_.quads.size()); ++q)
      if (chosen_[q])
        for (int side = 0; side < 4; ++side)
          if (is_to_split(q, side)) split(q, side);
    split_feature_edges();
    for (int q = 0; q < static_cast<int>(mesh_.quads.size()); ++q)
      if (chosen_[q]) refine(q);
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    return std::move(out_);
  }

 private:
  using Key = std::pair<int, int>;
  static Key key_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

  int begin_of(int q, int side) const { return mesh_.quads[q][side]; }
  int end_of(int q, int side) const { return mesh_.quads[q][(side + 1) & 3]; }

  /// Not a side of a curve whose number of edges somebody asked for.
  bool is_to_split(int q, int side) const {
    const int other = piece_.mesh.across(q, side);
    if (other >= 0 && !chosen_[other]) return false;
    const auto edge = feature_edges_.find(key_of(begin_of(q, side), end_of(q, side)));
    if (edge == feature_edges_.end()) return true;
    const int curve = edge->second.curve;
    const auto& curves = piece_.features.curves;
    return curve >= 0 && curve < static_cast<int>(curves.size()) && curves[curve].asked_count == 0;
  }

  /// The two vertices on it, from the end with the lower number to the other.
  void split(int q, int side) {
    const Key key = key_of(begin_of(q, side), end_of(q, side));
    if (on_side_.count(key) > 0) return;
    const auto edge = feature_edges_.find(key);
    const QuadMesh::FeatureEdge* curve = edge == feature_edges_.end() ? nullptr : &edge->second;
    std::array<int, 2> vertices{};
    for (int i = 0; i < 2; ++i) {
      const Vector3 p = point_on_side(mesh_, piece_, curve, key.first, key.second, (i + 1) / 3.0);
      vertices[i] = curve ? add_vertex(p, VertexKind::kCurve, curve->curve, -1) : add_inside(p, piece_.region[q]);
    }
    on_side_[key] = vertices;
  }

  void split_feature_edges() {
    const std::size_t before = out_.feature_edges.size();
    for (std::size_t i = 0; i < before; ++i) {
      const QuadMesh::FeatureEdge edge = out_.feature_edges[i];
      const auto found = on_side_.find(key_of(edge.a, edge.b));
      if (found == on_side_.end()) continue;
      auto [near, far] = found->second;
      if (edge.a > edge.b) std::swap(near, far);
      out_.feature_edges[i].b = near;
      out_.feature_edges.push_back({near, far, edge.curve});
      out_.feature_edges.push_back({far, edge.b, edge.curve});
    }
  }

  void refine(int q) {
    std::array<int, 4> sides{};
    for (int side = 0; side < 4; ++side) sides[side] = on_side_.count(key_of(begin_of(q, side), end_of(q, side))) > 0;
    for (const Template& t : templates())
      for (int turn = 0; turn < 4; ++turn) {
        std::array<int, 4> turned{};
        for (int side = 0; side < 4; ++side) turned[side] = sides[(side + turn) & 3];
        if (turned == t.sides) return fill(q, turn, t);
      }
  }

  void fill(int q, int turn, const Template& t) {
    std::array<int, 16> vertex{};
    vertex.fill(-1);
    for (int side = 0; side < 4; ++side) {
      const int from = begin_of(q, (side + turn) & 3), to = end_of(q, (side + turn) & 3);
      vertex[side] = from;
      if (t.sides[side] == 0) continue;
      const std::array<int, 2>& on = on_side_.at(key_of(from, to));
      vertex[4 + 2 * side] = on[from < to ? 0 : 1];
      vertex[5 + 2 * side] = on[from < to ? 1 : 0];
    }
    for (std::size_t i = 0; i < t.quads.size(); ++i) {
      std::array<int, 4> quad{};
      for (int k = 0; k < 4; ++k) {
        int& v = vertex[t.quads[i][k]];
        if (v < 0) v = add_inside(place_inside(q, (t.quads[i][k] - 12 + turn) & 3), piece_.region[q]);
        quad[k] = v;
      }
      touched_.insert(touched_.end(), quad.begin(), quad.end());
      if (i == 0)
        out_.quads[q] = quad;
      else
        out_.quads.push_back(quad);
    }
  }

  /// A third of the way from a corner to the one across.
  Vector3 place_inside(int q, int corner) const {
    const auto at = [&](int k) -> const Vector3& { return mesh_.positions[mesh_.quads[q][(corner + k) & 3]]; };
    return (4 * at(0) + 2 * at(1) + at(2) + 2 * at(3)) / 9;
  }

  int add_vertex(const Vector3& position, VertexKind kind, int anchor, int near_face) {
    out_.positions.push_back(position);
    out_.kind.push_back(kind);
    out_.anchor.push_back(anchor);
    out_.near_face.push_back(near_face);
    return static_cast<int>(out_.positions.size()) - 1;
  }

  int add_inside(const Vector3& position, int region) {
    SurfaceIndex::Filter filter;
    filter.region = piece_.region_filter(region);
    const SurfacePoint point = piece_.index.nearest(position, filter);
    return add_vertex(point.face < 0 ? position : point.position, VertexKind::kFree, region, point.face);
  }

  const QuadMesh& mesh_;
  const Workpiece& piece_;
  const std::vector<char>& chosen_;
  std::vector<int>& touched_;
  QuadMesh out_;
  std::map<Key, QuadMesh::FeatureEdge> feature_edges_;
  std::map<Key, std::array<int, 2>> on_side_;
};

}  // namespace

QuadMesh refine_locally(const QuadMesh& mesh, const Workpiece& piece, const std::vector<char>& chosen,
                        std::vector<int>* touched) {
  return LocalRefiner(mesh, piece, chosen, touched).run();
}

}  // namespace hybrid_quad
