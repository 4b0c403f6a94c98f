#include "hybrid_quad/improve/spread_along_bends.h"

#include <algorithm>
#include <limits>

#include "hybrid_quad/improve/chord_spacing.h"

namespace hybrid_quad {

namespace {

constexpr double kNegligible = 0.002;  // in edge lengths: deviations that nobody sees
constexpr double kCounts = 0.7;        // of the largest deviation of all chains: those with less are near enough
constexpr double kWorthwhile = 0.97;   // of a chain's largest deviation, or less, has to be left

/// Vertices along a curve from end to end, or all around.
struct Chain {
  std::vector<int> vertices;  ///< on the curve, without corners
  bool between_corners = false;
};

std::vector<Chain> chains_of(const Workpiece& piece) {
  std::vector<Chain> chains;
  std::vector<char> seen(piece.mesh.vertex_count(), 0);
  const auto is_inner = [&](int v) { return v >= 0 && piece.may_slide(v); };
  for (int seed = 0; seed < piece.mesh.vertex_count(); ++seed) {
    if (seen[seed] || !is_inner(seed)) continue;
    int first = seed;
    for (int left = piece.mesh.vertex_count(); left > 0 && is_inner(piece.previous[first]); --left) {
      first = piece.previous[first];
      if (first == seed) break;
    }
    Chain chain;
    for (int v = first; is_inner(v) && !seen[v]; v = piece.next[v]) {
      seen[v] = 1;
      chain.vertices.push_back(v);
    }
    chain.between_corners = piece.previous[chain.vertices.front()] >= 0 && piece.next[chain.vertices.back()] >= 0;
    const bool is_closed = piece.curves[piece.mesh.anchor(first)].closed();
    if (is_closed ? chain.vertices.size() > 2 : chain.between_corners) chains.push_back(std::move(chain));
  }
  return chains;
}

CurveSpacing spacing_of(const Workpiece& piece, const Chain& chain, double share) {
  CurveSpacing spacing;
  for (const int v : chain.vertices) {
    spacing.arc.push_back(piece.arc[v]);
    spacing.room.push_back(piece.mesh.is_pinned(v) ? 0.0 : share * std::min(piece.gap(v, 1), piece.gap(v, -1)));
  }
  const CurveGeometry& curve = piece.curves[piece.mesh.anchor(chain.vertices[0])];
  if (curve.closed()) return spacing;
  spacing.arc.insert(spacing.arc.begin(), 0.0);
  spacing.arc.push_back(curve.length());
  spacing.room.insert(spacing.room.begin(), 0.0);
  spacing.room.push_back(0.0);
  return spacing;
}

/// Some vertices with all that may change there, to be put back.
class Place {
 public:
  /// The vertices of a chain and of `rings` rings of quads around them.
  Place(const Workpiece& piece, const Chain& chain, int rings) : vertices_(chain.vertices) {
    for (int ring = 0; ring < rings; ++ring) {
      quads_.clear();
      for (const int v : vertices_) quads_.insert(quads_.end(), piece.mesh.quads_at(v).begin(), piece.mesh.quads_at(v).end());
      make_unique(quads_);
      if (ring + 1 == rings) break;
      for (const int q : quads_) vertices_.insert(vertices_.end(), piece.mesh.quad(q).begin(), piece.mesh.quad(q).end());
      make_unique(vertices_);
    }
    for (const int v : vertices_) {
      if (piece.mesh.is_free(v)) free_.push_back(v);
      positions_.push_back(piece.mesh.positions[v]);
      faces_.push_back(piece.face[v]);
      arcs_.push_back(piece.arc[v]);
    }
  }

  const std::vector<int>& quads() const { return quads_; }
  const std::vector<int>& free_vertices() const { return free_; }

  void put_back(Workpiece& piece) const {
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      piece.mesh.positions[vertices_[i]] = positions_[i];
      piece.face[vertices_[i]] = faces_[i];
      piece.arc[vertices_[i]] = arcs_[i];
    }
  }

 private:
  static void make_unique(std::vector<int>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  std::vector<int> vertices_, quads_, free_, faces_;
  std::vector<Vector3> positions_;
  std::vector<double> arcs_;
};

/// Whether quads bear what has become of them: the poorer they are, the less they may lose.
/// \param before  of every quad
bool is_borne(const Smoother& smoother, const std::vector<int>& quads, const std::vector<double>& before) {
  constexpr double kGood = 0.85, kPoor = 0.6, kLoss = 0.05, kLossOfPoor = 0.005, kMeanLoss = 0.012;
  double lost = 0;
  for (const int q : quads) {
    const double now = smoother.signed_quality(q);
    if (now < kGood && now < before[q] - (now < kPoor ? kLossOfPoor : kLoss)) return false;
    lost += before[q] - now;
  }
  return lost <= kMeanLoss * static_cast<double>(quads.size());
}

double deviation_of(const Workpiece& piece, const Chain& chain) {
  return largest_chord_deviation(piece.curves[piece.mesh.anchor(chain.vertices[0])], spacing_of(piece, chain, 0).arc);
}

/// \param before  how good every quad was
bool spread(Workpiece& piece, Smoother& smoother, const Chain& chain, double largest, const std::vector<double>& before) {
  constexpr int kRings = 3, kSweeps = 4;
  constexpr double kEps = 1e-3;
  constexpr double kShares[] = {0.3, 0.15, 0.07};  // of the shorter edge at a vertex: how far it may move
  const CurveGeometry& curve = piece.curves[piece.mesh.anchor(chain.vertices[0])];
  const Place place(piece, chain, kRings);
  for (const double share : kShares) {
    const CurveSpacing spacing = spacing_of(piece, chain, share);
    const std::vector<double> arc = spaced_by_chords(curve, spacing);
    if (largest_chord_deviation(curve, arc) > kWorthwhile * largest) return false;
    const std::size_t first = curve.closed() ? 0 : 1;
    for (std::size_t i = 0; i < chain.vertices.size(); ++i) {
      const int v = chain.vertices[i];
      piece.arc[v] = arc[i + first];
      piece.mesh.positions[v] = curve.at(piece.arc[v]);
    }
    smoother.relax(place.free_vertices(), kSweeps, kEps);
    smoother.update_frames(place.quads(), false);
    if (is_borne(smoother, place.quads(), before)) return true;
    place.put_back(piece);
    smoother.update_frames(place.quads(), false);
  }
  return false;
}

}  // namespace

int spread_along_bends(Workpiece& piece, Smoother& smoother, const RunContext& context) {
  constexpr int kRounds = 4;
  const std::vector<Chain> chains = chains_of(piece);
  std::vector<double> quality;  // before all rounds, which share what quads may lose
  int changes = 0;
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> deviation;
    for (const Chain& chain : chains) deviation.push_back(deviation_of(piece, chain));
    const double largest = deviation.empty() ? 0.0 : *std::max_element(deviation.begin(), deviation.end());
    if (largest < kNegligible * piece.h || largest > kWorthwhile * last) break;
    last = largest;
    if (round == 0) {
      smoother.update_frames(false);
      quality.assign(piece.mesh.quad_count(), 0.0);
      for (int q = 0; q < piece.mesh.quad_count(); ++q)
        if (piece.mesh.alive(q)) quality[q] = smoother.signed_quality(q);
    }
    int changed = 0;
    for (std::size_t i = 0; i < chains.size(); ++i) {
      context.checkpoint((round + static_cast<double>(i) / chains.size()) / kRounds);
      if (deviation[i] > kCounts * largest) changed += spread(piece, smoother, chains[i], deviation[i], quality);
    }
    if (changed == 0) break;
    changes += changed;
  }
  return changes;
}

}  // namespace hybrid_quad
