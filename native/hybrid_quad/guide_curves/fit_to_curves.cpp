#include <algorithm>
#include <cmath>
#include <limits>

#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

/// A curve as evenly spread places, and the vertices of the chain that follows it, each with the place it stands for.
struct Chain {
  std::vector<Vector3> places;  ///< of a closed one without the first again
  std::vector<int> vertices;    ///< of a closed one without the first again
  std::vector<int> at;          ///< ascending, but for the turn of a closed one
  bool closed = false;
  double length = 0;  ///< mean, of an edge

  int edge_count() const { return static_cast<int>(vertices.size()) - (closed ? 0 : 1); }
  int wrapped(int i, std::size_t size) const { return static_cast<int>((i + size) % size); }
  const Vector3& place(int k) const { return places[wrapped(k, places.size())]; }
  int vertex(int i) const { return vertices[wrapped(i, vertices.size())]; }
  /// The place of vertex i, counted on beyond a closed chain's first.
  int place_of(int i) const {
    const int n = static_cast<int>(vertices.size()), turn = static_cast<int>(places.size());
    return i < 0 ? at[i + n] - turn : i >= n ? at[i - n] + turn : at[i];
  }
  bool has_edge(int i) const { return closed || (i >= 0 && i < edge_count()); }
};

std::vector<Vector3> spread(const FeatureCurve& curve, const TriangleMesh& input, int count) {
  std::vector<double> start{0};
  for (std::size_t i = 1; i < curve.vertices.size(); ++i)
    start.push_back(start.back() + (input.position(curve.vertices[i]) - input.position(curve.vertices[i - 1])).norm());
  std::vector<Vector3> places;
  std::size_t i = 0;
  for (int k = 0; k < count + (curve.closed ? 0 : 1); ++k) {
    const double s = start.back() * k / count;
    while (i + 2 < start.size() && start[i + 1] <= s) ++i;
    const double span = start[i + 1] - start[i], t = span > 0 ? std::clamp((s - start[i]) / span, 0.0, 1.0) : 0.0;
    places.push_back((1 - t) * input.position(curve.vertices[i]) + t * input.position(curve.vertices[i + 1]));
  }
  return places;
}

/// The nearest of the places first..last to p.
int nearest_place(const Chain& chain, int first, int last, const Vector3& p) {
  int best = first;
  double least = std::numeric_limits<double>::infinity();
  for (int k = first; k <= last; ++k) {
    const double distance = (chain.place(k) - p).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = k;
  }
  return best;
}

double squared_distance(const Vector3& a, const Vector3& b, const Vector3& p) {
  const Vector3 along = b - a;
  const double square = along.squaredNorm();
  return (a + (square > 0 ? std::clamp(along.dot(p - a) / square, 0.0, 1.0) : 0.0) * along - p).squaredNorm();
}

class CurveFit {
 public:
  CurveFit(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const std::vector<char>& chosen,
           const std::vector<GuideEdge>& rings);
  void run();

 private:
  struct Link {
    int chain, index;  ///< the vertex is chains_[chain].vertices[index]
  };

  void add_chain(std::size_t begin, std::size_t end, const FeatureCurve& curve, const TriangleMesh& input);
  bool improve(int v, double step);
  double cost(int v, const Vector3& p) const;
  double edge_cost(const Chain& chain, int edge, int moved, const Vector3& p, int from, int to) const;
  double shape_at(int v) const;

  QuadMesh& quads_;
  std::vector<Chain> chains_;
  std::vector<std::vector<Link>> links_;     // by vertex
  std::vector<std::vector<int>> quads_at_;   // by vertex, of those that move
  std::vector<int> moving_;
  std::vector<Vector3> start_;               // of moving_, by vertex
  std::vector<double> length_;               // mean of the edges on chains, by vertex
  std::vector<double> shape_;                // least that is allowed, by vertex
};

CurveFit::CurveFit(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const std::vector<char>& chosen,
                   const std::vector<GuideEdge>& rings)
    : quads_(quads), links_(quads.positions.size()), quads_at_(quads.positions.size()), start_(quads.positions),
      length_(quads.positions.size(), 0), shape_(quads.positions.size(), 0) {
  constexpr double kShape = 0.35;
  const std::vector<QuadMesh::FeatureEdge>& edges = quads.feature_edges;
  std::vector<char> fixed(quads.positions.size(), 0);
  for (const GuideEdge& e : rings) fixed[e.a] = fixed[e.b] = 1;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].curve == edges[begin].curve) ++end;
    const int curve = edges[begin].curve;
    if (chosen[curve]) {
      add_chain(begin, end, features.curves[curve], input);
    } else {
      for (std::size_t i = begin; i < end; ++i) fixed[edges[i].a] = fixed[edges[i].b] = 1;
    }
  }
  std::vector<int> count(quads.positions.size(), 0);
  for (const Chain& chain : chains_)
    for (int i = 0; i < chain.edge_count(); ++i)
      for (const int v : {chain.vertex(i), chain.vertex(i + 1)}) {
        length_[v] += (quads.positions[chain.vertex(i + 1)] - quads.positions[chain.vertex(i)]).norm();
        ++count[v];
      }
  for (int v = 0; v < static_cast<int>(count.size()); ++v) {
    if (count[v] > 0) length_[v] /= count[v];
    if (count[v] > 1 && !fixed[v]) moving_.push_back(v);
  }
  for (int q = 0; q < static_cast<int>(quads.quads.size()); ++q)
    for (const int v : quads.quads[q])
      if (count[v] > 1 && !fixed[v]) quads_at_[v].push_back(q);
  for (const int v : moving_) shape_[v] = std::min(kShape, shape_at(v));
}

void CurveFit::add_chain(std::size_t begin, std::size_t end, const FeatureCurve& curve, const TriangleMesh& input) {
  constexpr int kPlaces = 20;  // an edge
  const std::vector<QuadMesh::FeatureEdge>& edges = quads_.feature_edges;
  Chain chain;
  chain.closed = curve.closed;
  chain.places = spread(curve, input, kPlaces * static_cast<int>(end - begin));
  for (std::size_t i = begin; i < end; ++i) {
    chain.vertices.push_back(edges[i].a);
    chain.length += (quads_.positions[edges[i].b] - quads_.positions[edges[i].a]).norm() / static_cast<double>(end - begin);
  }
  if (!chain.closed) chain.vertices.push_back(edges[end - 1].b);
  const int last = static_cast<int>(chain.places.size()) - 1;
  for (const int v : chain.vertices) chain.at.push_back(nearest_place(chain, 0, last, quads_.positions[v]));
  if (chain.closed)
    std::rotate(chain.places.begin(), chain.places.begin() + chain.at.front(), chain.places.end());
  const int shift = chain.closed ? chain.at.front() : 0;
  for (int& k : chain.at) k = chain.wrapped(k - shift, chain.places.size());
  if (!chain.closed) {
    chain.at.front() = 0;
    chain.at.back() = last;
  }
  if (!std::is_sorted(chain.at.begin(), chain.at.end())) return;  // it runs back and forth: nothing to go by
  for (int i = 0; i < static_cast<int>(chain.vertices.size()); ++i)
    links_[chain.vertices[i]].push_back({static_cast<int>(chains_.size()), i});
  chains_.push_back(std::move(chain));
}

/// Of an edge of a chain with one end moved to p: the fourth power of the distances of the curve's places, so that the farthest
/// count. A second one would let a bend go for the sake of what is straight, a sixth gets stuck between vertices.
double CurveFit::edge_cost(const Chain& chain, int edge, int moved, const Vector3& p, int from, int to) const {
  const auto position = [&](int v) -> const Vector3& { return v == moved ? p : quads_.positions[v]; };
  const Vector3 &a = position(chain.vertex(edge)), &b = position(chain.vertex(edge + 1));
  double sum = 0;
  for (int k = from; k <= to; ++k) {
    const double square = squared_distance(a, b, chain.place(k)) / (chain.length * chain.length);
    sum += square * square;
  }
  return sum;
}

double CurveFit::cost(int v, const Vector3& p) const {
  constexpr double kStay = 1e-5;
  double sum = kStay * (p - start_[v]).squaredNorm() / (length_[v] * length_[v]);
  for (const Link& link : links_[v]) {
    const Chain& chain = chains_[link.chain];
    const bool before = chain.has_edge(link.index - 1), after = chain.has_edge(link.index);
    const int first = before ? chain.place_of(link.index - 1) : chain.at[link.index];
    const int last = after ? chain.place_of(link.index + 1) : chain.at[link.index];
    const int at = before && after ? nearest_place(chain, first, last, p) : chain.at[link.index];
    if (before) sum += edge_cost(chain, link.index - 1, v, p, first, at);
    if (after) sum += edge_cost(chain, link.index, v, p, at, last);
  }
  return sum;
}

double CurveFit::shape_at(int v) const {
  double least = 1;
  for (const int q : quads_at_[v]) {
    const auto& c = quads_.quads[q];
    const std::vector<Vector3>& p = quads_.positions;
    least = std::min(least, scaled_jacobian(p[c[0]], p[c[1]], p[c[2]], p[c[3]]));
  }
  return least;
}

/// Tries steps along the chain and square to it. \return whether one was taken
bool CurveFit::improve(int v, double step) {
  constexpr double kReach = 0.3;  // of an edge
  const Link& link = links_[v].front();
  const Chain& chain = chains_[link.chain];
  const int before = chain.has_edge(link.index - 1) ? chain.vertex(link.index - 1) : v;
  const int after = chain.has_edge(link.index) ? chain.vertex(link.index + 1) : v;
  const Vector3 along = (quads_.positions[after] - quads_.positions[before]).normalized();
  const Vector3 helper = std::abs(along.z()) < 0.7 ? Vector3(0, 0, 1) : Vector3(1, 0, 0);
  const Vector3 side = along.cross(helper).normalized();
  if (!along.allFinite()) return false;
  bool any = false;
  double best = cost(v, quads_.positions[v]);
  for (const Vector3& axis : {along, side, Vector3(along.cross(side))})
    for (const double sign : {1.0, -1.0}) {
      const Vector3 kept = quads_.positions[v], p = kept + sign * step * length_[v] * axis;
      if ((p - start_[v]).norm() > kReach * length_[v]) continue;
      const double now = cost(v, p);
      if (!(now < best)) continue;
      quads_.positions[v] = p;
      if (shape_at(v) < shape_[v]) {
        quads_.positions[v] = kept;
        continue;
      }
      best = now;
      any = true;
      break;
    }
  if (!any) return false;
  for (const Link& on : links_[v]) {
    Chain& moved = chains_[on.chain];
    if (moved.has_edge(on.index - 1) && moved.has_edge(on.index) && on.index > 0)
      moved.at[on.index] = nearest_place(moved, moved.place_of(on.index - 1), moved.place_of(on.index + 1), quads_.positions[v]);
  }
  return true;
}

void CurveFit::run() {
  constexpr double kLongest = 0.08, kShortest = 0.004;  // of an edge
  constexpr int kSweeps = 12;
  for (double step = kLongest; step > kShortest; step /= 2)
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      bool any = false;
      for (const int v : moving_)
        if (!links_[v].empty()) any |= improve(v, step);
      if (!any) break;
    }
}

}  // namespace

void fit_to_curves(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const std::vector<char>& chosen,
                   const std::vector<GuideEdge>& rings) {
  CurveFit(quads, input, features, chosen, rings).run();
}

}  // namespace hybrid_quad
