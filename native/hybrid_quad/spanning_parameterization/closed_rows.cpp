#include "hybrid_quad/spanning_parameterization/closed_rows.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

namespace hybrid_quad {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// A closed row: out along the tree to a state, over one more half-edge, and back along the tree.
struct Candidate {
  float length;
  int tree, state, over, back;  ///< over: half-edge; back: the state beyond it
  GeneratingLoops::Set flips;

  bool operator<(const Candidate& other) const {
    return std::tie(length, tree, state, over) < std::tie(other.length, other.tree, other.state, other.over);
  }
};

/// The shortest ways of a row's end from one face, by states: faces with directions, 4 face + direction.
class RowTree {
 public:
  RowTree(const MovableGrid& grid, const GeneratingLoops& loops, int face, int direction, const RunContext& context)
      : grid_(grid), mesh_(grid.mesh()), loops_(loops) {
    const std::size_t states = 4 * static_cast<std::size_t>(mesh_.face_count());
    distance_.assign(states, kFar);
    over_.assign(states, -1);
    flips_.assign(states, 0);
    grow(4 * face + direction, context);
  }

  /// Adds the rows that flip something and are no longer than the limit.
  void list_candidates(int tree, float longest, std::vector<Candidate>& candidates) const {
    for (std::size_t state = 0; state < distance_.size(); ++state) {
      if (distance_[state] == kFar) continue;
      const int s = static_cast<int>(state);
      for (int h = 3 * (s / 4); h < 3 * (s / 4) + 3; ++h) {
        const int next = beyond(s, h);
        if (next < 0 || distance_[next] == kFar) continue;
        const GeneratingLoops::Set flips = flips_[s] ^ flips_[next] ^ loops_.through(h);
        const float length = distance_[s] + step(s, h) + distance_[next];
        if (flips != 0 && length <= longest) candidates.push_back({length, tree, s, h, next, flips});
      }
    }
  }

  ClosedRow row(const Candidate& candidate) const {
    std::vector<int> out = way_to(candidate.state), back = way_to(candidate.back);
    std::size_t common = 0;
    while (common < std::min(out.size(), back.size()) && out[common] == back[common]) ++common;
    int start = candidate.state;
    for (std::size_t i = out.size(); i-- > common;) start = before(start, out[i]);
    ClosedRow row{kUnitSteps[start % 4], {out.begin() + static_cast<std::ptrdiff_t>(common), out.end()}};
    row.crossed.push_back(candidate.over);
    for (std::size_t i = back.size(); i-- > common;) row.crossed.push_back(mesh_.opposite(back[i]));
    return row;
  }

 private:
  /// The state that a row's end comes to over half-edge h, -1 where it may not cross.
  int beyond(int state, int h) const {
    const int o = mesh_.opposite(h);
    const IntVector2& b = kUnitSteps[state % 4];
    if (o < 0 || !grid_.may_cross(h, b)) return -1;
    return 4 * (o / 3) + direction_of(turned(b, grid_.frames().matching[h]));
  }

  int before(int state, int h) const {
    return 4 * (h / 3) + direction_of(turned(kUnitSteps[state % 4], grid_.frames().matching[mesh_.opposite(h)]));
  }

  float step(int state, int h) const {
    const double crossing = grid_.measure().axis[h] >= 0 ? kFeatureCrossing : 0;
    return static_cast<float>(grid_.step_length(state / 4, mesh_.opposite(h) / 3) + crossing);
  }

  void grow(int start, const RunContext& context) {
    using Step = std::pair<float, int>;
    const double longest = grid_.longest_way(start / 4);
    std::priority_queue<Step, std::vector<Step>, std::greater<Step>> front;
    distance_[start] = 0;
    front.push({0.0f, start});
    for (std::size_t steps = 1; !front.empty(); ++steps) {
      const auto [distance, state] = front.top();
      front.pop();
      if (distance > distance_[state]) continue;
      if ((steps & 0x3fff) == 0) context.checkpoint(0.48);
      for (int h = 3 * (state / 4); h < 3 * (state / 4) + 3; ++h) {
        const int next = beyond(state, h);
        if (next < 0) continue;
        const float there = distance + step(state, h);
        if (there >= distance_[next] || there > longest) continue;
        distance_[next] = there;
        over_[next] = h;
        flips_[next] = flips_[state] ^ loops_.through(h);
        front.push({there, next});
      }
    }
  }

  std::vector<int> way_to(int state) const {
    std::vector<int> crossed;
    while (over_[state] >= 0) {
      crossed.push_back(over_[state]);
      state = before(state, over_[state]);
    }
    std::reverse(crossed.begin(), crossed.end());
    return crossed;
  }

  const MovableGrid& grid_;
  const TriangleMesh& mesh_;
  const GeneratingLoops& loops_;
  std::vector<float> distance_;
  std::vector<int> over_;  ///< half-edge crossed last, -1 at the start
  std::vector<GeneratingLoops::Set> flips_;
};

}  // namespace

bool LoopSums::add(GeneratingLoops::Set flips) {
  if (rank() == 64) return false;
  const Row row = reduced({flips, GeneratingLoops::Set{1} << rank()});
  if (row.flips != 0) rows_.push_back(row);
  return row.flips != 0;
}

std::optional<GeneratingLoops::Set> LoopSums::sum_for(GeneratingLoops::Set flips) const {
  const Row row = reduced({flips, 0});
  return row.flips == 0 ? std::optional(row.of) : std::nullopt;
}

/// Each row has a lowest loop that no later row has.
LoopSums::Row LoopSums::reduced(Row row) const {
  for (const Row& other : rows_)
    if (row.flips & other.flips & -other.flips) row = {row.flips ^ other.flips, row.of ^ other.of};
  return row;
}

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

std::vector<ClosedRow> closed_rows_that_flip(const MovableGrid& grid, const GeneratingLoops& loops, GeneratingLoops::Set wanted,
                                             int face, const RunContext& context) {
  std::vector<RowTree> trees;
  std::vector<Candidate> candidates;
  for (int direction = 0; direction < 2; ++direction) {  // the others are the same rows the other way around
    trees.emplace_back(grid, loops, face, direction, context);
    trees.back().list_candidates(direction, static_cast<float>(2 * grid.longest_way(face)), candidates);
  }
  std::sort(candidates.begin(), candidates.end());
  LoopSums sums;
  std::vector<const Candidate*> independent;
  std::optional<GeneratingLoops::Set> chosen;
  for (const Candidate& candidate : candidates) {
    if (!sums.add(candidate.flips)) continue;
    independent.push_back(&candidate);
    if ((chosen = sums.sum_for(wanted))) break;
  }
  std::vector<ClosedRow> rows;
  for (std::size_t k = 0; chosen && k < independent.size(); ++k)
    if (*chosen >> k & 1) rows.push_back(trees[independent[k]->tree].row(*independent[k]));
  return rows;
}

}  // namespace hybrid_quad
