#include "hybrid_quad/spanning_parameterization/curve_counts.h"

#include <algorithm>
#include <map>

namespace hybrid_quad {

namespace {

struct ParityLink {
  int corner;
  int parity;  ///< of the quad edges between
};

/// Corners that curves with an asked count connect.
std::map<int, std::vector<ParityLink>> parity_links(const FeatureGraph& features) {
  std::map<int, std::vector<ParityLink>> links;
  for (const FeatureCurve& curve : features.curves) {
    const int a = curve.vertices.front(), b = curve.vertices.back();
    if (curve.asked_count <= 0 || curve.closed || a == b) continue;
    links[a].push_back({b, curve.asked_count & 1});
    links[b].push_back({a, curve.asked_count & 1});
  }
  return links;
}

}  // namespace

CornerSigns corner_signs(const FeatureGraph& features, const std::vector<PhasePair>& psi) {
  const std::map<int, std::vector<ParityLink>> links = parity_links(features);
  CornerSigns signs;
  std::map<int, int> sign;
  for (const auto& [seed, none] : links) {
    if (sign.count(seed)) continue;
    std::vector<int> members{seed};
    sign[seed] = 1;
    int agreement = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const int v = members[i];
      agreement += psi[v].a.real() >= 0 ? sign[v] : -sign[v];
      for (const ParityLink& link : links.at(v)) {
        if (sign.count(link.corner)) continue;
        sign[link.corner] = link.parity ? -sign[v] : sign[v];
        members.push_back(link.corner);
      }
    }
    for (const int v : members) {
      signs.vertex.push_back(v);
      signs.sign.push_back(agreement >= 0 ? sign[v] : -sign[v]);
    }
  }
  return signs;
}

void impose(const CornerSigns& signs, std::vector<PhasePair>& psi) {
  for (std::size_t i = 0; i < signs.vertex.size(); ++i) {
    const double s = signs.sign[i];
    psi[signs.vertex[i]] = {{s, 0}, {s, 0}};
  }
}

void settle_curve_counts(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
                         LiftedGrid& grid) {
  const TriangleMesh& mesh = surface.mesh;
  const auto& curves = surface.features.curves;
  std::vector<double> length(curves.size(), 0.0);
  std::vector<std::vector<int>> edges(curves.size());
  const auto lifted_along = [&](int h) {
    return along_sign(measure, h) * grid.across_half_edge(mesh, h)[measure.axis[h]];
  };
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (measure.axis[h] >= 0 && h > mesh.opposite(h)) {
      length[surface.features.halfedge_curve[h]] += lifted_along(h);
      edges[surface.features.halfedge_curve[h]].push_back(h);
    }
  grid.curve_count.assign(curves.size(), 0);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const auto surplus = [&](int x, int y) {
      return lifted_along(x) - measure.along[x].norm() < lifted_along(y) - measure.along[y].norm();
    };
    const auto change = [&](int h, int by) {
      IntVector2 jump = grid.jump[h];
      jump[measure.axis[h]] += by * along_sign(measure, h);
      set_jump(mesh, frames, h, jump, grid);
      length[c] += by;
    };
    const int asked = curves[c].asked_count;
    const double least = asked > 0 ? asked : fewest_curve_edges(curves[c]);
    constexpr int kMostSteps = 1000;
    for (int step = 0; !edges[c].empty() && length[c] < least - 0.5 && step < kMostSteps; ++step)
      change(*std::min_element(edges[c].begin(), edges[c].end(), surplus), 2);
    for (int step = 0; asked > 0 && !edges[c].empty() && length[c] > asked + 1.5 && step < kMostSteps; ++step)
      change(*std::max_element(edges[c].begin(), edges[c].end(), surplus), -2);
    grid.curve_count[c] = rounded(length[c]);
  }
}

}  // namespace hybrid_quad
