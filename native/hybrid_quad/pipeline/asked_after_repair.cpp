#include "hybrid_quad/pipeline/asked_after_repair.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace hybrid_quad {

namespace {

/// Over the diagonal: as far from an edge are vertices that split it, in several rounds, or that its ends were collapsed into.
constexpr double kOnEdge = 1e-8;

using Edge = std::array<int, 2>;

Edge sorted_pair(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The edges of the built mesh between vertices of the polygon soup, and the chains of them along lines.
class BuiltEdges {
 public:
  BuiltEdges(const PolygonSoup& soup, const BuiltMesh& built);

  /// The vertices of the edges from a to b straight on; empty where there are none.
  std::vector<int> chain(int a, int b) const;

 private:
  using Cell = std::array<long long, 3>;

  Cell cell_of(const Vector3& p) const;
  std::vector<int> vertices_at(const Vector3& p) const;
  bool extend(const Vector3& end, std::set<int>& seen, std::vector<int>& chain) const;

  const PolygonSoup& soup_;
  double tolerance_;
  std::vector<Edge> edges_;  ///< both ways, ascending
  std::map<Cell, std::vector<int>> vertices_;
};

BuiltEdges::BuiltEdges(const PolygonSoup& soup, const BuiltMesh& built) : soup_(soup), tolerance_(kOnEdge * built.mesh.diagonal()) {
  const TriangleMesh& mesh = built.mesh;
  edges_.reserve(2 * static_cast<std::size_t>(mesh.halfedge_count()));
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int a = built.input_vertex[mesh.from(h)], b = built.input_vertex[mesh.to(h)];
    edges_.push_back({a, b});
    edges_.push_back({b, a});
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  for (std::size_t i = 0; i < edges_.size(); ++i)
    if (i == 0 || edges_[i][0] != edges_[i - 1][0]) vertices_[cell_of(soup.positions[edges_[i][0]])].push_back(edges_[i][0]);
}

BuiltEdges::Cell BuiltEdges::cell_of(const Vector3& p) const {
  Cell cell;
  for (int i = 0; i < 3; ++i) cell[i] = std::llround(p[i] / tolerance_);
  return cell;
}

std::vector<int> BuiltEdges::vertices_at(const Vector3& p) const {
  std::vector<int> found;
  const Cell middle = cell_of(p);
  for (int k = 0; k < 27; ++k) {
    const auto cell = vertices_.find({middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1});
    if (cell == vertices_.end()) continue;
    for (const int v : cell->second)
      if ((soup_.positions[v] - p).norm() <= tolerance_) found.push_back(v);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Goes on from the last vertex of a chain, nearest vertices first, and back where there is no way on.
bool BuiltEdges::extend(const Vector3& end, std::set<int>& seen, std::vector<int>& chain) const {
  // By hand: a chain may have as many vertices as a mesh.
  std::vector<std::vector<int>> choices;
  const auto choices_at = [&](int v) {
    const Vector3 way = end - soup_.positions[v];
    const double length = way.norm();
    std::vector<std::pair<double, int>> ahead;
    for (auto e = std::lower_bound(edges_.begin(), edges_.end(), Edge{v, 0}); e != edges_.end() && (*e)[0] == v; ++e) {
      const Vector3 step = soup_.positions[(*e)[1]] - soup_.positions[v];
      const double along = step.dot(way) / length;
      if (along > 0 && along <= length + tolerance_ && (step - way * (along / length)).norm() <= tolerance_) ahead.push_back({-along, (*e)[1]});
    }
    std::sort(ahead.begin(), ahead.end());
    std::vector<int> farthest_first;
    for (const auto& [along, w] : ahead) farthest_first.push_back(w);
    return farthest_first;
  };
  for (;;) {
    if ((soup_.positions[chain.back()] - end).norm() <= tolerance_) return true;
    if (choices.size() < chain.size()) choices.push_back(choices_at(chain.back()));
    while (!choices.empty() && choices.back().empty()) {
      choices.pop_back();
      chain.pop_back();
    }
    if (chain.empty()) return false;
    const int next = choices.back().back();
    choices.back().pop_back();
    if (seen.insert(next).second) chain.push_back(next);
  }
}

std::vector<int> BuiltEdges::chain(int a, int b) const {
  if (std::binary_search(edges_.begin(), edges_.end(), Edge{a, b})) return {a, b};
  std::vector<int> starts = vertices_at(soup_.positions[a]);
  std::stable_partition(starts.begin(), starts.end(), [a](int v) { return v == a; });
  std::set<int> seen;
  for (const int start : starts) {
    std::vector<int> found{start};
    seen.insert(start);
    if (extend(soup_.positions[b], seen, found)) return found;
  }
  return {};
}

/// Whether every one of these edges is one of the built mesh.
bool are_built(std::vector<Edge> edges, const BuiltMesh& built) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<char> is_found(edges.size(), 0);
  for (int h = 0; h < built.mesh.halfedge_count(); ++h) {
    const Edge edge = sorted_pair(built.input_vertex[built.mesh.from(h)], built.input_vertex[built.mesh.to(h)]);
    const auto found = std::lower_bound(edges.begin(), edges.end(), edge);
    if (found != edges.end() && *found == edge) is_found[found - edges.begin()] = 1;
  }
  return std::all_of(is_found.begin(), is_found.end(), [](char is) { return is != 0; });
}

/// The first value that is not free of those that were merged into a vertex, its own before all others.
template <class Value, class IsFree>
void take_merged(const std::vector<int>& welded_into, const IsFree& is_free, std::vector<Value>& values) {
  for (std::size_t v = 0; v < values.size(); ++v) {
    Value& kept = values[welded_into[v]];
    if (is_free(kept)) kept = values[v];
  }
}

void take_strongest(const std::vector<int>& welded_into, std::vector<double>& density) {
  const auto strength = [](double x) { return std::abs(std::log(x)); };
  for (std::size_t v = 0; v < density.size(); ++v) {
    double& kept = density[welded_into[v]];
    if (strength(density[v]) > strength(kept)) kept = density[v];
  }
}

/// Polygons that were left out as copies, each with one at the same places that is in the built mesh.
std::vector<std::array<int, 2>> copied_polygons(const PolygonSoup& soup, const BuiltMesh& built) {
  const auto copies = std::find_if(built.defects.begin(), built.defects.end(), [](const Defect& d) { return d.code == "duplicate_face"; });
  if (copies == built.defects.end()) return {};
  std::vector<std::size_t> begin{0};
  for (const int size : soup.face_sizes) begin.push_back(begin.back() + size);
  using Places = std::vector<std::array<double, 3>>;
  const auto places_of = [&](int f) {
    Places places;
    for (std::size_t c = begin[f]; c < begin[f + 1]; ++c) {
      const Vector3& p = soup.positions[soup.face_vertices[c]];
      places.push_back({p.x(), p.y(), p.z()});
    }
    std::sort(places.begin(), places.end());
    return places;
  };
  std::vector<char> is_built(soup.face_sizes.size(), 0);
  for (const int f : built.input_face) is_built[f] = 1;
  std::map<Places, int> built_at;
  for (int f = 0; f < static_cast<int>(is_built.size()); ++f)
    if (is_built[f]) built_at.emplace(places_of(f), f);
  std::vector<std::array<int, 2>> pairs;
  for (const int f : copies->elements) {
    if (is_built[f]) continue;
    const auto found = built_at.find(places_of(f));
    if (found != built_at.end()) pairs.push_back({f, found->second});
  }
  return pairs;
}

template <class Value, class IsFree>
void take_copied(const std::vector<std::array<int, 2>>& copies, const IsFree& is_free, std::vector<Value>& values) {
  for (const auto& [copy, kept] : copies)
    if (is_free(values[kept])) values[kept] = values[copy];
}

}  // namespace

RemeshOptions asked_after_repair(const PolygonSoup& soup, const BuiltMesh& built, const RemeshOptions& asked,
                                 std::vector<std::string>& warnings) {
  RemeshOptions out = asked;
  const std::vector<int>& target = built.welded_into;
  const auto is_free_guide = [](const Vector3& guide) { return guide.isZero(0); };
  const auto is_free_frame = [](const std::array<Vector3, 2>& frame) { return frame[0].isZero(0) && frame[1].isZero(0); };
  take_merged(target, is_free_guide, out.vertex_guides);
  take_merged(target, is_free_frame, out.vertex_frames);
  take_strongest(target, out.density);
  if (!asked.face_guides.empty() || !asked.face_frames.empty()) {
    const std::vector<std::array<int, 2>> copies = copied_polygons(soup, built);
    if (!asked.face_guides.empty()) take_copied(copies, is_free_guide, out.face_guides);
    if (!asked.face_frames.empty()) take_copied(copies, is_free_frame, out.face_frames);
  }

  std::vector<Edge> all;
  for (Edge& e : out.marked_edges) {
    e = {target[e[0]], target[e[1]]};
    all.push_back(sorted_pair(e[0], e[1]));
  }
  for (CurveCount& curve : out.curve_counts) {
    for (int& v : curve.vertices) v = target[v];
    for (std::size_t k = 0; k + 1 < curve.vertices.size(); ++k) all.push_back(sorted_pair(curve.vertices[k], curve.vertices[k + 1]));
  }
  if (all.empty() || are_built(std::move(all), built)) return out;

  const BuiltEdges edges(soup, built);
  std::set<Edge> gone;
  for (const auto& [a, b] : std::exchange(out.marked_edges, {})) {
    if (a == b) continue;  // without length
    const std::vector<int> chain = edges.chain(a, b);
    if (chain.empty()) gone.insert(sorted_pair(a, b));
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) out.marked_edges.push_back({chain[i], chain[i + 1]});
  }
  if (!gone.empty())
    warnings.push_back(std::to_string(gone.size()) + (gone.size() == 1 ? " marked edge" : " marked edges") +
                       " went when the input was repaired: no edge is in " + (gone.size() == 1 ? "its place" : "their places"));
  for (CurveCount& curve : out.curve_counts) {
    std::vector<int> path;
    const auto add = [&path](int v) {
      if (path.empty() || path.back() != v) path.push_back(v);
    };
    for (std::size_t k = 0; k + 1 < curve.vertices.size(); ++k) {
      const int a = curve.vertices[k], b = curve.vertices[k + 1];
      std::vector<int> chain = edges.chain(a, b);
      if (chain.empty()) chain = {a, b};  // in its length, though on no edge
      for (const int v : chain) add(v);
    }
    curve.vertices = std::move(path);
  }
  return out;
}

}  // namespace hybrid_quad
