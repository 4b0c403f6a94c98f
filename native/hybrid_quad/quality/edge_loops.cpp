#include "hybrid_quad/quality/edge_loops.h"

#include <algorithm>
#include <cstdlib>

namespace hybrid_quad {

namespace {

/// Traces chains along darts. A dart that runs against its chain has the sign -1.
class LoopTracer {
 public:
  explicit LoopTracer(const QuadComplex& complex)
      : complex_(complex), quads_(complex.positions.size(), 0), is_border_(complex.positions.size(), 0),
        sign_(complex.opposite.size(), 0), place_(complex.opposite.size(), 0) {
    for (std::size_t d = 0; d < complex.opposite.size(); ++d) {
      ++quads_[complex.vertex[d]];
      if (complex.opposite[d] < 0)
        is_border_[complex.vertex[d]] = is_border_[complex.to(static_cast<int>(d))] = 1;
    }
  }

  EdgeLoops trace() {
    loops_.of_dart.assign(complex_.opposite.size(), -1);
    for (int d = 0; d < static_cast<int>(complex_.opposite.size()); ++d)
      if (loops_.of_dart[d] < 0) add_chain(d);
    for (int d = 0; d < static_cast<int>(complex_.opposite.size()); ++d) {
      EdgeLoops::Chain& chain = loops_.chains[loops_.of_dart[d]];
      if (!is_border_[complex_.to(d)] && goes_on(d) && loops_.of_dart[QuadComplex::next(d)] == loops_.of_dart[d])
        chain.crosses_itself = true;
      if (is_beside_itself(d)) chain.spirals = true;
    }
    return std::move(loops_);
  }

 private:
  /// Whether a chain along dart d goes straight on at its end.
  bool goes_on(int d) const {
    const int v = complex_.to(d);
    if (complex_.kind[v] == VertexKind::kCorner) return false;
    return is_border_[v] ? complex_.opposite[d] < 0 && quads_[v] == 2 : quads_[v] == 4;
  }
  /// The same at its begin.
  bool goes_back(int d) const {
    const int v = complex_.from(d);
    if (complex_.kind[v] == VertexKind::kCorner) return false;
    return is_border_[v] ? complex_.opposite[d] < 0 && quads_[v] == 2 : quads_[v] == 4;
  }
  int straight_on(int d) const { return QuadComplex::next(complex_.opposite[QuadComplex::next(d)]); }
  int straight_back(int d) const { return QuadComplex::previous(complex_.opposite[QuadComplex::previous(d)]); }

  void mark(int d, int chain, int place) {
    loops_.of_dart[d] = chain;
    sign_[d] = 1;
    place_[d] = place;
    const int other = complex_.opposite[d];
    if (other < 0) return;
    loops_.of_dart[other] = chain;
    sign_[other] = -1;
    place_[other] = place;
  }

  void add_chain(int first) {
    const int id = static_cast<int>(loops_.chains.size());
    EdgeLoops::Chain chain;
    mark(first, id, 0);
    chain.length = 1;
    int d = first;
    while (goes_on(d)) {
      d = straight_on(d);
      if (d == first) {
        chain.is_closed = true;
        break;
      }
      mark(d, id, chain.length++);
    }
    int before = 0;
    for (d = first; !chain.is_closed && goes_back(d); ++chain.length) {
      d = straight_back(d);
      mark(d, id, --before);
    }
    loops_.chains.push_back(chain);
  }

  /// How many edges apart two sides of one chain are along it.
  int way_between(int d, int e) const {
    const EdgeLoops::Chain& chain = loops_.chains[loops_.of_dart[d]];
    const int way = std::abs(place_[d] - place_[e]);
    return chain.is_closed ? std::min(way, chain.length - way) : way;
  }

  bool is_beside_itself(int d) const {
    constexpr int kBeside = 3;
    int side = d;
    for (int across = 1; across <= kBeside; ++across) {
      const int far = QuadComplex::next(QuadComplex::next(side));
      // The far side of a quad is a dart that runs the other way.
      if (loops_.of_dart[far] == loops_.of_dart[d] && sign_[far] == -sign_[d] && way_between(far, d) > across) return true;
      side = complex_.opposite[far];
      if (side < 0) break;
    }
    return false;
  }

  const QuadComplex& complex_;
  std::vector<int> quads_;       ///< #V: at the vertex
  std::vector<char> is_border_;  ///< #V
  std::vector<int> sign_;        ///< 4 #Q
  std::vector<int> place_;       ///< 4 #Q: number of the edge along its chain
  EdgeLoops loops_;
};

}  // namespace

EdgeLoops trace_edge_loops(const QuadComplex& complex) { return LoopTracer(complex).trace(); }

EdgeLoopSummary summary_of(const EdgeLoops& loops) {
  EdgeLoopSummary summary;
  std::vector<int> lengths;
  for (const EdgeLoops::Chain& chain : loops.chains) {
    lengths.push_back(chain.length);
    ++(chain.is_closed ? summary.closed : summary.open);
    summary.self_crossing += chain.crosses_itself;
    summary.spirals += chain.spirals;
    if (chain.spirals) summary.longest_spiral = std::max(summary.longest_spiral, chain.length);
  }
  if (lengths.empty()) return summary;
  std::sort(lengths.begin(), lengths.end());
  summary.longest = lengths.back();
  summary.median_length = 0.5 * (lengths[(lengths.size() - 1) / 2] + lengths[lengths.size() / 2]);
  return summary;
}

EdgeLoopSummary edge_loops_of(const QuadMesh& mesh) {
  QuadComplex complex = complex_of_quads(mesh.positions, mesh.quads);
  complex.kind = mesh.kind;
  return summary_of(trace_edge_loops(complex));
}

}  // namespace hybrid_quad
