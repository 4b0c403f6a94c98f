#include "hybrid_quad/spanning_parameterization/row_cycles.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace hybrid_quad {

namespace {

/// Sites and the routes between them that are in no cycle yet.
class RouteGraph {
 public:
  explicit RouteGraph(const std::vector<RowRoute>& routes) : routes_(routes), used_(routes.size(), 0) {
    for (std::size_t i = 0; i < routes.size(); ++i) {
      at_[routes[i].from].push_back(static_cast<int>(i));
      at_[routes[i].to].push_back(static_cast<int>(i));
    }
  }

  /// The shortest cycle of unused routes through one of them, which is first; empty if there is none.
  RowCycle take_cycle(int through) {
    RowCycle cycle;
    if (used_[through]) return cycle;
    const int start = routes_[through].to, goal = routes_[through].from;
    std::map<int, int> arrived{{start, -1}};  // site: the route it was reached by
    std::vector<int> front{start};
    for (std::size_t k = 0; k < front.size() && arrived.count(goal) == 0; ++k)
      for (const int i : at_.at(front[k])) {
        const int next = routes_[i].from == front[k] ? routes_[i].to : routes_[i].from;
        if (used_[i] || i == through || !arrived.emplace(next, i).second) continue;
        front.push_back(next);
      }
    if (arrived.count(goal) == 0) return cycle;
    cycle.push_back(through);
    for (int site = goal; arrived.at(site) >= 0;) {
      const int i = arrived.at(site);
      cycle.push_back(i);
      site = routes_[i].from == site ? routes_[i].to : routes_[i].from;
    }
    for (const int i : cycle) used_[i] = 1;
    return cycle;
  }

 private:
  const std::vector<RowRoute>& routes_;
  std::map<int, std::vector<int>> at_;
  std::vector<char> used_;
};

}  // namespace

std::vector<RowCycle> cycles_of(const std::vector<RowRoute>& routes) {
  RouteGraph graph(routes);
  std::vector<RowCycle> cycles;
  for (std::size_t i = 0; i < routes.size(); ++i) {
    RowCycle cycle = graph.take_cycle(static_cast<int>(i));
    if (cycle.empty()) continue;
    std::sort(cycle.begin(), cycle.end());  // later routes were found with the earlier ones made
    cycles.push_back(std::move(cycle));
  }
  return cycles;
}

GeneratingLoops::Set flipped_by(const RowCycle& cycle, const std::vector<RowRoute>& routes, const GeneratingLoops& loops) {
  GeneratingLoops::Set flips = 0;
  for (const int i : cycle) {
    for (const int h : routes[i].crossed) flips ^= loops.through(h);
    if (routes[i].end == RowRoute::End::kBoundary) flips ^= loops.through(routes[i].end_halfedge);
  }
  return flips;
}

std::vector<int> cycles_to_leave_out(const std::vector<RowCycle>& cycles, const std::vector<GeneratingLoops::Set>& flips) {
  std::vector<int> order(cycles.size()), independent;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return cycles[a].size() < cycles[b].size(); });
  LoopSums sums;
  GeneratingLoops::Set all = 0;
  for (const int i : order) {
    all ^= flips[i];
    if (sums.add(flips[i])) independent.push_back(i);
  }
  const GeneratingLoops::Set odd = sums.sum_for(all).value_or(0);
  std::vector<int> left_out;
  for (std::size_t k = 0; k < independent.size(); ++k)
    if (odd >> k & 1) left_out.push_back(independent[k]);
  return left_out;
}

}  // namespace hybrid_quad
