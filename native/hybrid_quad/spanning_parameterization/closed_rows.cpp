#include "hybrid_quad/spanning_parameterization/closed_rows.h"

#include <algorithm>
#include <bitset>
#include <functional>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace hybrid_quad {

namespace {

std::size_t loop_count(GeneratingLoops::Set set) { return std::bitset<64>(set).count(); }

/// Faces with directions, 4 face + direction, reached by rows that have crossed the same loops an odd number of times.
struct Layer {
  GeneratingLoops::Set crossed;
  std::vector<float> distance;
  std::vector<int> over;          ///< half-edge crossed last, -1 at the start
  std::vector<int> before;        ///< layer before that
  std::vector<char> settled;
};

class ClosedRowSearch {
 public:
  ClosedRowSearch(const MovableGrid& grid, const GeneratingLoops& loops, GeneratingLoops::Set wanted, std::size_t most_left,
                  std::size_t& states)
      : grid_(grid), mesh_(grid.mesh()), loops_(loops), wanted_(wanted), most_left_(most_left), states_left_(states) {}

  /// Replaces `best` where a row through face f in the given direction is shorter.
  void run(int f, int direction, const RunContext& context, double& shortest, ClosedRow& best) {
    const int start = 4 * f + direction;
    layers_.clear();
    number_.clear();
    heap_.clear();
    reach(layer(0), start, 0, -1, -1);
    while (!heap_.empty() && states_left_ > 0) {
      const auto [distance, k, state] = heap_.front();
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<Step>());
      heap_.pop_back();
      if (layers_[k].settled[state]) continue;
      if (distance >= shortest) return;
      layers_[k].settled[state] = 1;
      if ((--states_left_ & 0x3fff) == 0) context.checkpoint(0.48);
      const GeneratingLoops::Set crossed = layers_[k].crossed;
      if (state == start && loop_count(wanted_ ^ crossed) <= most_left_) {
        shortest = distance;
        best = {kUnitSteps[direction], way_to(k, state)};
        return;
      }
      const int t = state / 4;
      const IntVector2& b = kUnitSteps[state % 4];
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int o = mesh_.opposite(h);
        if (o < 0 || !grid_.may_cross(h, b)) continue;
        const double crossing = grid_.measure().axis[h] >= 0 ? kFeatureCrossing : 0;
        reach(layer(crossed ^ loops_.through(h)), 4 * (o / 3) + direction_of(turned(b, grid_.frames().matching[h])),
              static_cast<float>(distance + grid_.step_length(t, o / 3) + crossing), h, k);
      }
    }
  }

 private:
  using Step = std::tuple<float, int, int>;  // distance, layer, state

  /// Number of a layer, -1 where there are too many.
  int layer(GeneratingLoops::Set crossed) {
    constexpr std::size_t kMostLayers = 64;
    if (number_.size() >= kMostLayers && number_.count(crossed) == 0) return -1;
    const auto [place, fresh] = number_.try_emplace(crossed, static_cast<int>(layers_.size()));
    if (fresh) {
      const std::size_t states = 4 * static_cast<std::size_t>(mesh_.face_count());
      layers_.push_back({crossed, std::vector<float>(states, std::numeric_limits<float>::infinity()),
                         std::vector<int>(states, -1), std::vector<int>(states, -1), std::vector<char>(states, 0)});
    }
    return place->second;
  }

  void reach(int k, int state, float distance, int over, int before) {
    if (k < 0) return;
    Layer& at = layers_[k];
    if (distance >= at.distance[state]) return;
    at.distance[state] = distance;
    at.over[state] = over;
    at.before[state] = before;
    heap_.emplace_back(distance, k, state);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<Step>());
  }

  std::vector<int> way_to(int k, int state) const {
    std::vector<int> crossed;
    while (layers_[k].over[state] >= 0) {
      const int h = layers_[k].over[state], back = mesh_.opposite(h);
      crossed.push_back(h);
      k = layers_[k].before[state];
      state = 4 * (h / 3) + direction_of(turned(kUnitSteps[state % 4], grid_.frames().matching[back]));
    }
    std::reverse(crossed.begin(), crossed.end());
    return crossed;
  }

  const MovableGrid& grid_;
  const TriangleMesh& mesh_;
  const GeneratingLoops& loops_;
  GeneratingLoops::Set wanted_;
  std::size_t most_left_;     ///< of the wanted loops, or too many
  std::size_t& states_left_;  ///< to be settled
  std::vector<Layer> layers_;
  std::unordered_map<GeneratingLoops::Set, int> number_;
  std::vector<Step> heap_;
};

}  // namespace

GeneratingLoops::GeneratingLoops(const TriangleMesh& mesh) : mesh_(mesh), through_(mesh.halfedge_count(), 0) {
  std::vector<char> seen_vertex(mesh.vertex_count(), 0), in_tree(mesh.halfedge_count(), 0), seen_face(mesh.face_count(), 0);
  const auto take = [&](int h, std::vector<char>& set) {
    set[h] = 1;
    if (mesh.opposite(h) >= 0) set[mesh.opposite(h)] = 1;
  };
  std::vector<int> front;
  for (int start = 0; start < mesh.vertex_count(); ++start) {
    if (seen_vertex[start] || mesh.outgoing(start) < 0) continue;
    seen_vertex[start] = 1;
    front = {start};
    for (std::size_t i = 0; i < front.size(); ++i) {
      const int p = front[i], first = mesh.outgoing(p);
      for (int h = first;;) {
        for (const int edge : {h, TriangleMesh::previous(h)}) {
          const int q = mesh.from(edge) == p ? mesh.to(edge) : mesh.from(edge);
          if (seen_vertex[q]) continue;
          seen_vertex[q] = 1;
          take(edge, in_tree);
          tree_.push_back({q, p, edge});
          front.push_back(q);
        }
        h = mesh.rotate_ccw(h);
        if (h < 0 || h == first) break;
      }
    }
  }
  std::vector<char> crossed(mesh.halfedge_count(), 0);
  for (int start = 0; start < mesh.face_count(); ++start) {
    if (seen_face[start]) continue;
    seen_face[start] = 1;
    front = {start};
    for (std::size_t i = 0; i < front.size(); ++i)
      for (int h = 3 * front[i]; h < 3 * front[i] + 3; ++h) {
        const int o = mesh.opposite(h);
        if (o < 0 || in_tree[h] || seen_face[o / 3]) continue;
        seen_face[o / 3] = 1;
        take(h, crossed);
        front.push_back(o / 3);
      }
  }
  std::vector<Set> below(mesh.vertex_count(), 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (h < mesh.opposite(h) || in_tree[h] || crossed[h]) continue;
    if (loops_++ >= 64) continue;
    closing_.push_back(h);
    const Set bit = Set{1} << (loops_ - 1);
    through_[h] ^= bit;
    below[mesh.from(h)] ^= bit;
    below[mesh.to(h)] ^= bit;
  }
  for (auto edge = tree_.rbegin(); edge != tree_.rend(); ++edge) {
    through_[edge->halfedge] = below[edge->vertex];
    below[edge->parent] ^= below[edge->vertex];
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (mesh.opposite(h) >= 0) through_[h] |= through_[mesh.opposite(h)];
}

GeneratingLoops::Set GeneratingLoops::odd(const LiftedGrid& grid) const {
  std::vector<char> sign(mesh_.vertex_count(), 0);
  for (const TreeEdge& edge : tree_) sign[edge.vertex] = sign[edge.parent] != is_odd(grid.jump[edge.halfedge]);
  Set set = 0;
  for (std::size_t i = 0; i < closing_.size(); ++i) {
    const int h = closing_[i];
    if ((sign[mesh_.from(h)] != sign[mesh_.to(h)]) != is_odd(grid.jump[h])) set |= Set{1} << i;
  }
  return set;
}

std::optional<ClosedRow> shortest_closed_row(const MovableGrid& grid, const GeneratingLoops& loops, GeneratingLoops::Set wanted,
                                             const std::vector<int>& faces, std::size_t& states_left,
                                             const RunContext& context) {
  if (wanted == 0) return std::nullopt;
  ClosedRow best;
  for (const std::size_t most_left : {std::size_t{0}, loop_count(wanted) - 1}) {
    std::size_t half = states_left / 2;
    states_left -= half;
    ClosedRowSearch search(grid, loops, wanted, most_left, half);
    for (const int f : faces) {
      double shortest = grid.longest_way(f);
      for (int direction = 0; direction < 4; ++direction) search.run(f, direction, context, shortest, best);
      if (!best.crossed.empty()) break;
    }
    states_left += half;
    if (!best.crossed.empty()) return best;
  }
  return std::nullopt;
}

}  // namespace hybrid_quad
