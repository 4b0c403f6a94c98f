#include "hybrid_quad/spanning_parameterization/curve_counts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>

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

/// How many chords a curve takes, each no farther from it than a part of a quad edge: one as long as sqrt(8 d r) is d from an arc of
/// radius r. Turns are those of pieces half an edge long.
/// \param edge  of usual length (scene units)  \param deviation  in edges
double chords_for_bends(const TriangleMesh& mesh, const FeatureCurve& curve, double edge, double deviation) {
  const double step = edge / 2;
  std::vector<Vector3> points{mesh.position(curve.vertices.front())};
  double walked = 0;
  for (std::size_t i = 1; i < curve.vertices.size(); ++i) {
    walked += (mesh.position(curve.vertices[i]) - mesh.position(curve.vertices[i - 1])).norm();
    if (walked < step) continue;
    points.push_back(mesh.position(curve.vertices[i]));
    walked = 0;
  }
  if (curve.closed && (points.back() - points.front()).norm() < step) points.pop_back();
  const std::size_t count = points.size();
  double chords = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!curve.closed && (i == 0 || i + 1 == count)) continue;
    const Vector3 in = points[i] - points[(i + count - 1) % count], out = points[(i + 1) % count] - points[i];
    const double turn = std::atan2(in.cross(out).norm(), in.dot(out));
    chords += std::sqrt(turn * 0.5 * (in.norm() + out.norm()) / (8 * deviation * edge));
  }
  return chords;
}

/// That of quads that are all alike.
double usual_edge(const TriangleMesh& mesh, const GridMeasure& measure) {
  double quads = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const Vector2 &a = measure.along[3 * f], &b = measure.along[3 * f + 1];
    quads += 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
  }
  return quads > 0 ? std::sqrt(mesh.total_area() / quads) : 0;
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

std::vector<CountRange> allowed_counts(const WorkingSurface& surface, const GridMeasure& measure) {
  constexpr double kShorter = 0.7, kLonger = 1.5;
  constexpr double kDeviation = 0.12;  // of chords from a bend, in edges
  const TriangleMesh& mesh = surface.mesh;
  const auto& curves = surface.features.curves;
  const bool any_asked = std::any_of(curves.begin(), curves.end(), [](const FeatureCurve& c) { return c.asked_count > 0; });
  std::vector<double> length(curves.size(), 0.0);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (measure.axis[h] >= 0 && h > mesh.opposite(h)) length[surface.features.halfedge_curve[h]] += measure.along[h].norm();
  const double edge = usual_edge(mesh, measure);
  std::vector<CountRange> ranges;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const int most = any_asked ? static_cast<int>(kLonger * length[c]) + 2 : std::numeric_limits<int>::max();
    // Where bends take more edges than that, as many as they take, if frames measure so many.
    const double bends = edge > 0 ? std::min(length[c], chords_for_bends(mesh, curves[c], edge, kDeviation)) : 0;
    const int fewest = static_cast<int>(std::max(kShorter * length[c], bends));
    ranges.push_back({std::max(fewest_curve_edges(curves[c]), fewest), most});
    if (curves[c].asked_count > 0) ranges.back() = {curves[c].asked_count, curves[c].asked_count};
  }
  return ranges;
}

std::vector<char> faces_near_counts(const WorkingSurface& surface, const FrameField& frames) {
  constexpr double kNear = 6;  // quads
  const TriangleMesh& mesh = surface.mesh;
  const auto& curves = surface.features.curves;
  if (std::none_of(curves.begin(), curves.end(), [](const FeatureCurve& c) { return c.asked_count > 0; })) return {};
  std::vector<Vector3> centre;
  std::vector<double> distance(mesh.face_count(), kNear);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto& t = mesh.face(f);
    centre.push_back((mesh.position(t[0]) + mesh.position(t[1]) + mesh.position(t[2])) / 3);
    for (int h = 3 * f; h < 3 * f + 3; ++h)
      if (surface.features.is_feature(h) && curves[surface.features.halfedge_curve[h]].asked_count > 0) distance[f] = 0;
    if (distance[f] == 0) queue.emplace(0, f);
  }
  while (!queue.empty()) {
    const auto [at, f] = queue.top();
    queue.pop();
    if (at > distance[f]) continue;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int g = mesh.opposite(h) / 3;
      if (mesh.opposite(h) < 0) continue;
      const double reached = at + (centre[f] - centre[g]).norm() * std::sqrt(frames.du[f].cross(frames.dv[f]).norm());
      if (reached >= distance[g]) continue;
      queue.emplace(distance[g] = reached, g);
    }
  }
  std::vector<char> near(mesh.face_count());
  std::transform(distance.begin(), distance.end(), near.begin(), [](double d) { return d < kNear; });
  return near;
}

}  // namespace hybrid_quad
