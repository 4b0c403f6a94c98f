#include "hybrid_quad/frame_field/cross_hierarchy.h"

#include <cmath>
#include <utility>

#include "hybrid_quad/mesh/bucket_sort.h"

namespace hybrid_quad {

namespace {

constexpr double kTiny = 1e-300;

void build_rows(CrossLevel& level) {
  const int n = level.system.size();
  level.row_begin.assign(n + 1, 0);
  for (const CrossLink& link : level.system.links) {
    ++level.row_begin[link.from + 1];
    ++level.row_begin[link.to + 1];
  }
  for (int i = 0; i < n; ++i) level.row_begin[i + 1] += level.row_begin[i];
  level.neighbour.resize(level.row_begin[n]);
  level.weight.resize(level.row_begin[n]);
  std::vector<int> fill(level.row_begin.begin(), level.row_begin.end() - 1);
  for (const CrossLink& link : level.system.links) {
    level.neighbour[fill[link.to]] = link.from;
    level.weight[fill[link.to]++] = link.weight;
    level.neighbour[fill[link.from]] = link.to;
    level.weight[fill[link.from]++] = std::conj(link.weight);
  }
}

/// Pairs every node with the free neighbour it is tied to most strongly. \return number of aggregates
int aggregate_pairs(CrossLevel& level) {
  constexpr double kWeakest = 1e-4;  // relative strength below which two nodes know nothing of each other
  const int n = level.system.size();
  const std::vector<double>& diagonal = level.system.diagonal;
  level.aggregate.assign(n, -1);
  level.prolongation.assign(n, Complex(1, 0));
  int count = 0;
  for (int i = 0; i < n; ++i) {
    if (level.aggregate[i] >= 0) continue;
    int best = -1;
    double strongest = kWeakest;
    for (int e = level.row_begin[i]; e < level.row_begin[i + 1]; ++e) {
      const int j = level.neighbour[e];
      if (level.aggregate[j] >= 0) continue;
      const double strength = std::abs(level.weight[e]) / std::sqrt(diagonal[i] * diagonal[j] + kTiny);
      if (strength > strongest) {
        strongest = strength;
        best = e;
      }
    }
    level.aggregate[i] = count;
    if (best >= 0) {
      const int j = level.neighbour[best];
      level.aggregate[j] = count;
      level.prolongation[j] = std::conj(level.weight[best]) / std::abs(level.weight[best]);
    }
    ++count;
  }
  return count;
}

void merge_parallel_links(std::vector<CrossLink>& links) {
  sort_into_buckets(links, [](const CrossLink& link) { return link.to; });
  sort_into_buckets(links, [](const CrossLink& link) { return link.from; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < links.size();) {
    CrossLink merged = links[i++];
    for (; i < links.size() && links[i].from == merged.from && links[i].to == merged.to; ++i)
      merged.weight += links[i].weight;
    links[kept++] = merged;
  }
  links.resize(kept);
}

/// The Galerkin system on the aggregates of `level`.
CrossLevel coarsened(const CrossLevel& level, int count) {
  CrossLevel coarse;
  coarse.system.diagonal.assign(count, 0);
  coarse.system.source.assign(count, Complex(0, 0));
  for (int i = 0; i < level.system.size(); ++i) {
    coarse.system.diagonal[level.aggregate[i]] += level.system.diagonal[i];
    coarse.system.source[level.aggregate[i]] += std::conj(level.prolongation[i]) * level.system.source[i];
  }
  coarse.system.links.reserve(level.system.links.size());
  for (const CrossLink& link : level.system.links) {
    const int p = level.aggregate[link.from], q = level.aggregate[link.to];
    const Complex w = std::conj(level.prolongation[link.to]) * link.weight * level.prolongation[link.from];
    if (p == q) {
      coarse.system.diagonal[p] -= 2 * w.real();
    } else if (p < q) {
      coarse.system.links.push_back({p, q, w});
    } else {
      coarse.system.links.push_back({q, p, std::conj(w)});
    }
  }
  merge_parallel_links(coarse.system.links);
  build_rows(coarse);
  return coarse;
}

}  // namespace

std::vector<CrossLevel> cross_hierarchy(const CrossSystem& system, int coarsest, const RunContext& context) {
  std::vector<CrossLevel> levels(1);
  levels[0].system = system;
  build_rows(levels[0]);
  while (levels.back().system.size() > coarsest) {
    context.checkpoint(0.2);
    CrossLevel& fine = levels.back();
    const int count = aggregate_pairs(fine);
    // Nodes without ties stay alone for ever; stop where pairing no longer shrinks the level.
    if (count > 0.95 * fine.system.size()) break;
    CrossLevel coarse = coarsened(fine, count);
    levels.push_back(std::move(coarse));
  }
  return levels;
}

std::vector<Complex> prolonged(const CrossLevel& fine, const std::vector<Complex>& coarse) {
  std::vector<Complex> values(fine.system.size());
  for (int i = 0; i < fine.system.size(); ++i) values[i] = fine.prolongation[i] * coarse[fine.aggregate[i]];
  return values;
}

}  // namespace hybrid_quad
