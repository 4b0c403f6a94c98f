#include "hybrid_quad/features/curve_counts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace hybrid_quad {

namespace {

/// Whether the numbers of edges along curves from corner to corner are even or odd, as far as counts settle it.
class CornerParities {
 public:
  explicit CornerParities(int vertices) : parent_(vertices), parity_(vertices, 0) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  bool connected(int a, int b) const { return root(a).first == root(b).first; }
  /// \pre connected(a, b)
  int between(int a, int b) const { return root(a).second ^ root(b).second; }
  void connect(int a, int b, int parity) {
    const auto [ra, pa] = root(a);
    const auto [rb, pb] = root(b);
    if (ra == rb) return;
    parent_[ra] = rb;
    parity_[ra] = pa ^ pb ^ (parity & 1);
  }

 private:
  std::pair<int, int> root(int v) const {
    int parity = 0;
    for (; parent_[v] != v; v = parent_[v]) parity ^= parity_[v];
    return {v, parity};
  }

  std::vector<int> parent_;
  std::vector<int> parity_;  ///< from a vertex to its parent
};

double length_of(const TriangleMesh& mesh, const FeatureCurve& curve) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
    sum += (mesh.position(curve.vertices[i + 1]) - mesh.position(curve.vertices[i])).norm();
  return sum;
}

int least_count(const FeatureCurve& curve) { return curve.vertices.front() == curve.vertices.back() ? 4 : 1; }

/// The chain that each curve is part of, or -1.
std::vector<int> chains_of_curves(const TriangleMesh& mesh, const std::vector<CountedChain>& chains,
                                  const FeatureGraph& features) {
  std::map<std::array<int, 2>, int> chain_of;
  for (std::size_t i = 0; i < chains.size(); ++i)
    for (const auto& e : chains[i].edges) chain_of[{std::min(e[0], e[1]), std::max(e[0], e[1])}] = static_cast<int>(i);
  std::vector<int> of_curve(features.curves.size(), -1);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (!features.is_feature(h)) continue;
    const auto found = chain_of.find({std::min(mesh.from(h), mesh.to(h)), std::max(mesh.from(h), mesh.to(h))});
    if (found != chain_of.end()) of_curve[features.halfedge_curve[h]] = found->second;
  }
  return of_curve;
}

/// The chain's number in shares of the curves' lengths, each at least what the curve needs. The largest parts of a quad
/// that rounding would lose go first.
std::vector<int> dealt_out(const std::vector<double>& length, const std::vector<int>& least, int count) {
  const double total = std::max(std::accumulate(length.begin(), length.end(), 0.0), 1e-300);
  std::vector<int> dealt = least;
  int left = count - std::accumulate(least.begin(), least.end(), 0);
  for (; left > 0; --left) {
    std::size_t neediest = 0;
    double most = -1e300;
    for (std::size_t i = 0; i < length.size(); ++i) {
      const double missing = count * length[i] / total - dealt[i];
      if (missing > most) {
        most = missing;
        neediest = i;
      }
    }
    ++dealt[neediest];
  }
  return dealt;
}

void plan_chain(const TriangleMesh& mesh, int count, FeatureGraph& features, CornerParities& parities, PlannedChain& plan) {
  std::vector<double> length;
  std::vector<int> least;
  for (const int c : plan.curves) {
    length.push_back(length_of(mesh, features.curves[c]));
    least.push_back(least_count(features.curves[c]));
  }
  std::vector<int> dealt = dealt_out(length, least, count);
  const double total_length = std::accumulate(length.begin(), length.end(), 0.0);
  int carry = 0;  // edges that a curve could not have, for reasons of parity, and the next one gets
  for (std::size_t i = 0; i < dealt.size(); ++i) {
    const FeatureCurve& curve = features.curves[plan.curves[i]];
    const int a = curve.vertices.front(), b = curve.vertices.back();
    const int wanted = dealt[i] + carry;
    dealt[i] = std::max(wanted, least[i]);
    carry = wanted - dealt[i];
    if (a == b || parities.connected(a, b)) {
      const int parity = a == b ? 0 : parities.between(a, b);
      if ((dealt[i] & 1) != parity) {
        const double share = total_length > 0 ? count * length[i] / total_length : dealt[i];
        const int step = carry > 0 || dealt[i] - 1 < least[i] || share > dealt[i] ? 1 : -1;
        dealt[i] += step;
        carry -= step;
      }
    } else {
      parities.connect(a, b, dealt[i]);
    }
  }
  const auto longest = std::max_element(length.begin(), length.end()) - length.begin();
  if (carry % 2 == 0 && dealt[longest] + carry >= least[longest]) dealt[longest] += carry;
  for (std::size_t i = 0; i < dealt.size(); ++i) features.curves[plan.curves[i]].asked_count = dealt[i];
  plan.count = std::accumulate(dealt.begin(), dealt.end(), 0);
  if (plan.count == count) return;
  const bool too_few = count < std::accumulate(least.begin(), least.end(), 0);
  plan.obstacle = too_few ? CountObstacle::kTooFew : CountObstacle::kParity;
}

}  // namespace

std::vector<int> chain_ends(const CountedChain& chain) {
  std::map<int, int> degree;
  for (const auto& e : chain.edges)
    for (const int v : e) ++degree[v];
  std::vector<int> ends;
  for (const auto& [v, count] : degree)
    if (count == 1) ends.push_back(v);
  return ends;
}

std::vector<PlannedChain> plan_curve_counts(const TriangleMesh& mesh, const std::vector<CountedChain>& chains,
                                            FeatureGraph& features) {
  std::vector<PlannedChain> plans(chains.size());
  const std::vector<int> of_curve = chains_of_curves(mesh, chains, features);
  for (std::size_t c = 0; c < of_curve.size(); ++c)
    if (of_curve[c] >= 0) plans[of_curve[c]].curves.push_back(static_cast<int>(c));
  CornerParities parities(mesh.vertex_count());
  for (std::size_t i = 0; i < chains.size(); ++i)
    if (!plans[i].curves.empty()) plan_chain(mesh, chains[i].count, features, parities, plans[i]);
  return plans;
}

}  // namespace hybrid_quad
