#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/guide_curves/quad_sides.h"

namespace hybrid_quad {

namespace {

using Edge = std::array<int, 2>;

Edge sorted_pair(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// What a set of edges makes of a vertex on it: a copy for each sector of quads between two of these edges.
struct Copies {
  std::vector<int> darts;   ///< the fan
  std::vector<int> vertex;  ///< of each dart's quad
  std::vector<int> around;  ///< the different ones, counterclockwise
};

class RingInsertion {
 public:
  RingInsertion(const QuadMesh& mesh, const TriangleMesh& input, const FeatureGraph& before, const FeatureGraph& after)
      : mesh_(mesh), sides_(mesh), input_(input), before_(before), after_(after), out_(mesh) {}

  bool add_chain(const std::vector<Edge>& chain);
  bool split();
  QuadMesh take() { return std::move(out_); }
  void move_crossed(std::vector<GuideEdge>& crossed, int guide) const;

 private:
  void add(const Edge& e);
  int go_on_straight(int end);
  bool close_end(int end);
  int turn_cost(int came, int at, int next) const;
  bool may_pass(int v) const;
  bool may_end_at(int v, int start) const;
  bool may_split(const Edge& e) const;
  bool divide(int v);
  bool carry_features();
  void bind();
  int copy_at(int v, int dart) const;
  int region_of(int v) const;

  const QuadMesh& mesh_;
  QuadSides sides_;
  const TriangleMesh& input_;
  const FeatureGraph& before_;
  const FeatureGraph& after_;
  QuadMesh out_;
  std::set<Edge> ring_;                 // to become a strip
  std::set<Edge> chain_;                // of these, those that the guide runs along
  std::set<Edge> kept_;                 // feature edges that stay
  std::set<int> on_kept_;               // their ends
  std::map<int, int> curve_after_;      // of the curves that stay
  std::map<int, std::vector<int>> neighbours_;  // along the ring
  std::map<int, Copies> copies_;
};

/// The curve of `after` on which a curve of `before` lies, or -1.
int curve_in(const FeatureCurve& curve, const TriangleMesh& input, const FeatureGraph& after) {
  const int v = curve.vertices[0], w = curve.vertices[1], start = input.outgoing(v);
  for (int h = start; h >= 0;) {
    if (input.to(h) == w) return after.halfedge_curve[h];
    const int back = TriangleMesh::previous(h);
    if (input.from(back) == w) return after.halfedge_curve[back];
    h = input.rotate_ccw(h);
    if (h == start) break;
  }
  return -1;
}

bool RingInsertion::may_split(const Edge& e) const {
  return sides_.at(e[0], e[1]) >= 0 && sides_.at(e[1], e[0]) >= 0 && kept_.count(sorted_pair(e[0], e[1])) == 0;
}

bool RingInsertion::add_chain(const std::vector<Edge>& chain) {
  for (const QuadMesh::FeatureEdge& e : mesh_.feature_edges) {
    if (curve_after_.count(e.curve) == 0) curve_after_[e.curve] = curve_in(before_.curves[e.curve], input_, after_);
    if (curve_after_[e.curve] < 0) continue;
    kept_.insert(sorted_pair(e.a, e.b));
    on_kept_.insert({e.a, e.b});
  }
  for (const Edge& e : chain) {
    if (!may_split(e)) return false;
    add(e);
  }
  chain_ = ring_;
  std::vector<int> ends;
  for (const auto& [v, around] : neighbours_)
    if (around.size() == 1 && !sides_.on_boundary(v)) ends.push_back(v);
  for (int& end : ends) end = go_on_straight(end);
  for (const int end : ends)
    if (neighbours_[end].size() == 1 && !sides_.on_boundary(end) && !close_end(end)) return false;
  return !ring_.empty();
}

/// What it costs a strip that came from `came` to `at` to go on to `next`: turning makes irregular vertices.
int RingInsertion::turn_cost(int came, int at, int next) const {
  constexpr int kTurn = 4;  // edges
  const std::vector<int> fan = sides_.fan(at);
  if (fan.size() != 4) return kTurn;
  for (std::size_t i = 0; i < 4; ++i)
    if (sides_.to(fan[i]) == came) return sides_.to(fan[(i + 2) & 3]) == next ? 0 : kTurn;
  return kTurn;
}

bool RingInsertion::may_pass(int v) const { return neighbours_.count(v) == 0 && on_kept_.count(v) == 0; }

/// Another end of the ring, or a place on the boundary away from corners.
bool RingInsertion::may_end_at(int v, int start) const {
  const auto found = neighbours_.find(v);
  if (found != neighbours_.end()) return v != start && found->second.size() == 1 && !sides_.on_boundary(v);
  return mesh_.kind[v] == VertexKind::kCurve && sides_.on_boundary(v);
}

/// Adds the edge that continues the ring at its end, so that what turns around the end does so beyond it.
/// \return the new end; the old one where nothing continues it
int RingInsertion::go_on_straight(int end) {
  const std::vector<int> fan = sides_.fan(end);
  if (fan.size() != 4) return end;
  const int came = neighbours_[end][0];
  for (std::size_t i = 0; i < 4; ++i) {
    if (sides_.to(fan[i]) != came) continue;
    const int next = sides_.to(fan[(i + 2) & 3]);
    if (!may_split({end, next}) || neighbours_.count(next) || on_kept_.count(next)) return end;
    add({end, next});
    return next;
  }
  return end;
}

void RingInsertion::add(const Edge& e) {
  ring_.insert(sorted_pair(e[0], e[1]));
  neighbours_[e[0]].push_back(e[1]);
  neighbours_[e[1]].push_back(e[0]);
}

/// Continues the ring from an end inside the surface to another end or the boundary, by the shortest way along edges that
/// touches neither the ring nor features that stay, every turn being as much as some edges. \return false if there is none
bool RingInsertion::close_end(int end) {
  struct Step {
    int cost, dart;
    bool operator>(const Step& other) const { return std::tie(cost, dart) > std::tie(other.cost, other.dart); }
  };
  std::vector<int> cost(4 * mesh_.quads.size(), std::numeric_limits<int>::max()), before(cost.size(), -1);
  std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
  const auto reach = [&](int dart, int came, int so_far, int from_dart) {
    const int at = sides_.from(dart), next = sides_.to(dart);
    if (!may_split({at, next}) || ring_.count(sorted_pair(at, next))) return;
    const bool ends = may_end_at(next, end);
    if (!ends && !may_pass(next)) return;
    int sum = so_far + 1 + turn_cost(came, at, next);
    if (ends && neighbours_.count(next)) sum += turn_cost(at, next, neighbours_.at(next)[0]);
    if (sum >= cost[dart]) return;
    cost[dart] = sum;
    before[dart] = from_dart;
    queue.push({sum, dart});
  };
  for (const int d : sides_.fan(end)) reach(d, neighbours_.at(end)[0], 0, -1);
  while (!queue.empty()) {
    const Step step = queue.top();
    queue.pop();
    if (step.cost > cost[step.dart]) continue;
    const int at = sides_.to(step.dart);
    if (may_end_at(at, end)) {
      std::set<int> passed;
      for (int d = step.dart; d >= 0; d = before[d])
        if (!passed.insert(sides_.to(d)).second) return false;
      for (int d = step.dart; d >= 0; d = before[d]) add({sides_.from(d), sides_.to(d)});
      return true;
    }
    for (const int d : sides_.fan(at)) reach(d, sides_.from(step.dart), step.cost, step.dart);
  }
  return false;
}

/// Makes the copies of a vertex on the ring; the first one keeps its number.
bool RingInsertion::divide(int v) {
  Copies copies;
  copies.darts = sides_.fan(v);
  const bool boundary = sides_.opposite(copies.darts.front()) < 0;
  const auto is_ring = [&](int d) { return ring_.count(sorted_pair(sides_.from(d), sides_.to(d))) > 0; };
  if (!boundary) {
    const auto first = std::find_if(copies.darts.begin(), copies.darts.end(), is_ring);
    std::rotate(copies.darts.begin(), first, copies.darts.end());
  }
  for (std::size_t i = 0; i < copies.darts.size(); ++i) {
    if (i == 0 || is_ring(copies.darts[i])) {
      int vertex = v;
      if (i > 0) {
        vertex = static_cast<int>(out_.positions.size());
        out_.positions.push_back(mesh_.positions[v]);
        out_.kind.push_back(VertexKind::kFree);
        out_.anchor.push_back(-1);
        out_.near_face.push_back(mesh_.near_face[v]);
      }
      copies.around.push_back(vertex);
    }
    copies.vertex.push_back(copies.around.back());
  }
  const std::size_t count = copies.around.size();
  const bool is_sound = count == 2 || count == 4;
  // Apart, so that the strip has a width before anything is smoothed.
  constexpr double kApart = 0.35;
  for (const int copy : copies.around) {
    Vector3 sum = Vector3::Zero();
    int quads = 0;
    for (std::size_t i = 0; i < copies.darts.size(); ++i) {
      if (copies.vertex[i] != copy) continue;
      for (const int corner : mesh_.quads[copies.darts[i] / 4]) sum += 0.25 * mesh_.positions[corner];
      ++quads;
    }
    out_.positions[copy] = mesh_.positions[v] + kApart * (sum / quads - mesh_.positions[v]);
  }
  copies_[v] = std::move(copies);
  return is_sound;
}

int RingInsertion::copy_at(int v, int dart) const {
  const auto found = copies_.find(v);
  if (found == copies_.end()) return v;
  const Copies& copies = found->second;
  for (std::size_t i = 0; i < copies.darts.size(); ++i)
    if (copies.darts[i] / 4 == dart / 4) return copies.vertex[i];
  return v;
}

/// Feature edges that stay lead to one copy of each end; where they come from different sides of the ring, the edge across
/// the strip joins them. \return false where more than two of them, or a corner, lie on the ring
bool RingInsertion::carry_features() {
  out_.feature_edges.clear();
  std::map<int, std::vector<std::array<int, 3>>> at_ring;  // by vertex: its copy, the curve, whether the curve goes out there
  for (const QuadMesh::FeatureEdge& e : mesh_.feature_edges) {
    const int curve = curve_after_.at(e.curve);
    if (curve < 0) continue;
    const int d = sides_.at(e.a, e.b) >= 0 ? sides_.at(e.a, e.b) : sides_.at(e.b, e.a);
    const int a = copy_at(e.a, d), b = copy_at(e.b, d);
    out_.feature_edges.push_back({a, b, curve});
    if (copies_.count(e.a)) at_ring[e.a].push_back({a, curve, 1});
    if (copies_.count(e.b)) at_ring[e.b].push_back({b, curve, 0});
  }
  for (const auto& [v, ends] : at_ring) {
    const bool is_corner = mesh_.kind[v] == VertexKind::kCorner && mesh_.anchor[v] >= 0 && after_.is_corner[mesh_.anchor[v]];
    if (is_corner || ends.size() != 2 || ends[0][1] != ends[1][1]) return false;
    if (ends[0][0] != ends[1][0]) out_.feature_edges.push_back({ends[0][0], ends[1][0], ends[0][1]});
  }
  return true;
}

/// The region of `after` about a vertex on the ring or in a region of `before`.
int RingInsertion::region_of(int v) const {
  int face = -1;
  if (mesh_.kind[v] == VertexKind::kFree) {
    const auto found = std::find(before_.face_region.begin(), before_.face_region.end(), mesh_.anchor[v]);
    if (found != before_.face_region.end()) face = static_cast<int>(found - before_.face_region.begin());
  } else if (mesh_.kind[v] == VertexKind::kCurve) {
    face = input_.outgoing(before_.curves[mesh_.anchor[v]].vertices[0]) / 3;
  } else if (mesh_.anchor[v] >= 0) {
    face = input_.outgoing(mesh_.anchor[v]) / 3;
  }
  return face < 0 ? -1 : after_.face_region[face];
}

/// Kinds and anchors by the curves that stay.
void RingInsertion::bind() {
  std::vector<int> curve(out_.positions.size(), -1);
  for (const QuadMesh::FeatureEdge& e : out_.feature_edges) curve[e.a] = curve[e.b] = e.curve;
  std::vector<int> origin(out_.positions.size());
  for (std::size_t v = 0; v < origin.size(); ++v) origin[v] = static_cast<int>(v);
  for (const auto& [v, copies] : copies_)
    for (const int copy : copies.around) origin[copy] = v;
  std::map<int, int> region_of_region;
  for (std::size_t v = 0; v < origin.size(); ++v) {
    const int old = origin[v], anchor = mesh_.anchor[old];
    if (mesh_.kind[old] == VertexKind::kCorner && (anchor < 0 || after_.is_corner[anchor])) continue;
    if (curve[v] >= 0) {
      out_.kind[v] = VertexKind::kCurve;
      out_.anchor[v] = curve[v];
      continue;
    }
    out_.kind[v] = VertexKind::kFree;
    if (mesh_.kind[old] != VertexKind::kFree) {
      out_.anchor[v] = region_of(old);
      continue;
    }
    const auto known = region_of_region.find(anchor);
    out_.anchor[v] = known != region_of_region.end() ? known->second : (region_of_region[anchor] = region_of(old));
  }
}

bool RingInsertion::split() {
  for (const auto& [v, around] : neighbours_)
    if (!divide(v)) return false;
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
    for (int i = 0; i < 4; ++i) out_.quads[q][i] = copy_at(mesh_.quads[q][i], static_cast<int>(4 * q) + i);
  for (const Edge& e : ring_) {
    const int left = sides_.at(e[0], e[1]), right = sides_.at(e[1], e[0]);
    out_.quads.push_back({copy_at(e[0], right), copy_at(e[1], right), copy_at(e[1], left), copy_at(e[0], left)});
  }
  for (const auto& [v, copies] : copies_)
    if (copies.around.size() == 4) {
      const std::vector<int>& c = copies.around;
      out_.quads.push_back({c[0], c[1], c[2], c[3]});
    }
  if (!carry_features()) return false;
  bind();
  return violations_of(out_).empty();
}

/// Edges that other guides cross, where the strip runs along them, become two; the strip's own follow.
void RingInsertion::move_crossed(std::vector<GuideEdge>& crossed, int guide) const {
  std::vector<GuideEdge> moved;
  for (const GuideEdge& p : crossed) {
    // Both sides of the edge between the two; they are one where the strip does not run along it.
    std::set<Edge> now;
    for (const int d : {sides_.at(p.a, p.b), sides_.at(p.b, p.a)})
      if (d >= 0) now.insert({copy_at(p.a, d), copy_at(p.b, d)});
    for (const Edge& e : now) moved.push_back({e[0], e[1], p.guide});
  }
  for (const auto& [v, copies] : copies_) {
    bool on_chain = false;
    for (const int w : neighbours_.at(v)) on_chain |= chain_.count(sorted_pair(v, w)) > 0;
    if (!on_chain) continue;
    const std::size_t count = copies.around.size();
    for (std::size_t i = 0; i < (count > 2 ? count : 1); ++i)
      moved.push_back({copies.around[i], copies.around[(i + 1) % count], guide});
  }
  crossed = std::move(moved);
}

}  // namespace

bool insert_ring(QuadMesh& quads, std::vector<GuideEdge>& crossed, int guide, const std::vector<std::array<int, 2>>& chain,
                 const TriangleMesh& input, const FeatureGraph& before, const FeatureGraph& after) {
  RingInsertion insertion(quads, input, before, after);
  if (!insertion.add_chain(chain) || !insertion.split()) return false;
  insertion.move_crossed(crossed, guide);
  quads = insertion.take();
  return true;
}

}  // namespace hybrid_quad
