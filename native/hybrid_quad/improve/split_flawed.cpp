#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/mend.h"
#include "hybrid_quad/improve/side_splitting.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/mesh/quad_complex.h"

namespace hybrid_quad {

namespace {

constexpr std::array<HexagonFill, 5> kFills{HexagonFill::kFirstEdge, HexagonFill::kSecondEdge, HexagonFill::kStarAtFirst,
                                            HexagonFill::kStarAtSecond, HexagonFill::kInset};
constexpr std::array<std::array<double, 2>, 3> kPlaces{{{1.0 / 3, 2.0 / 3}, {0.2, 0.5}, {0.5, 0.8}}};

std::array<Vector3, 4> corners_of(const QuadMesh& mesh, int q) {
  const auto& v = mesh.quads[q];
  return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]], mesh.positions[v[3]]};
}

/// flawed_quads, which remembers quads by their corners: from one trial to the next nearly all stay where they are.
class FlawMemory {
 public:
  FlawMemory(const SurfaceIndex& whole, const Agreement& agreement, double edge)
      : whole_(whole), agreement_(agreement), edge_(edge) {}

  std::vector<int> flawed_of(const QuadMesh& mesh) {
    std::vector<int> flawed;
    for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
      if (is_flawed(corners_of(mesh, q))) flawed.push_back(q);
    return flawed;
  }

  bool is_flawed(const std::array<Vector3, 4>& corners) {
    constexpr double kLeastArea = 1e-10;
    const auto [known, is_new] = known_.try_emplace(corners, false);
    if (is_new)
      known->second = !(0.5 * (corners[2] - corners[0]).cross(corners[3] - corners[1]).norm() > kLeastArea * edge_ * edge_) ||
                      is_inverted(corners, whole_, agreement_);
    return known->second;
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<Vector3, 4>& corners) const {
      char bytes[sizeof(corners)];
      std::memcpy(bytes, corners.data(), sizeof(corners));
      return std::hash<std::string_view>()({bytes, sizeof(bytes)});
    }
  };

  const SurfaceIndex& whole_;
  Agreement agreement_;
  double edge_;
  std::unordered_map<std::array<Vector3, 4>, bool, Hash> known_;
};

class FlawedSplitter {
 public:
  FlawedSplitter(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                 const SurfaceIndex& whole, const Agreement& agreement, const ImproveOptions& options, const RunContext& context)
      : quads_(quads), input_(input), features_(features), index_(index), whole_(whole), agreement_(agreement), options_(options),
        context_(context), memory_(whole, agreement, mean_edge_length(quads)) {}

  /// A split that leaves as many flawed quads may lead to one that leaves fewer.
  int run() {
    constexpr int kMostSplits = 24, kMostInVain = 3;
    constexpr std::size_t kMostFlawed = 24;
    int splits = 0, kept = 0;
    std::vector<int> flawed = memory_.flawed_of(quads_);
    QuadMesh best = quads_;
    for (std::size_t least = flawed.size(); least > 0 && least <= kMostFlawed && splits < kMostSplits && splits - kept <= kMostInVain;) {
      if (!split_any(flawed)) break;
      ++splits;
      if (flawed.size() >= least) continue;
      least = flawed.size();
      kept = splits;
      best = quads_;
    }
    quads_ = std::move(best);
    return kept;
  }

 private:
  struct Candidate {
    SideSplit split;
    std::array<Vector3, 4> path;
    double detour = 0;  ///< length of the path over that of the side
    int flawed = 0, quads = 0;
  };

  bool is_valid(const QuadMesh& mesh) const {
    return violations_of(mesh).empty() && euler_characteristic(mesh) == euler_characteristic(quads_);
  }

  /// Splits a side of a flawed quad, if none has more that are flawed for it; `flawed` then are these.
  bool split_any(std::vector<int>& flawed) {
    const std::vector<int> now = flawed;
    Workpiece piece(quads_, input_, features_, index_);
    piece.bind_all();
    const SideSplitter splitter(quads_, index_, piece.region);
    for (const std::size_t most : {now.size() - 1, now.size()})
      for (const int q : now)
        if (split_at(q, most, splitter, piece, flawed)) return true;
    return false;
  }

  /// \param most  so many flawed quads may be left
  bool split_at(int q, std::size_t most, const SideSplitter& splitter, const Workpiece& piece, std::vector<int>& flawed) {
    constexpr std::size_t kTrials = 8;
    context_.checkpoint();
    std::vector<Candidate> candidates = candidates_at(q, splitter, piece);
    std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
      return std::make_tuple(x.flawed, -x.detour, x.quads) < std::make_tuple(y.flawed, -y.detour, y.quads);
    });
    for (std::size_t i = 0; i < std::min(kTrials, candidates.size()) && trials_left_ > 0; ++i, --trials_left_) {
      std::vector<int> changed;
      QuadMesh mesh = splitter.split(candidates[i].split, candidates[i].path, &changed);
      if (candidates[i].flawed > 0) mend(mesh, memory_.flawed_of(mesh));
      std::vector<int> left = memory_.flawed_of(mesh);
      if (left.size() > most || !is_valid(mesh)) continue;
      quads_ = std::move(mesh);
      flawed = std::move(left);
      return true;
    }
    return false;
  }

  std::vector<Candidate> candidates_at(int q, const SideSplitter& splitter, const Workpiece& piece) const {
    std::vector<Candidate> out;
    for (int side = 0; side < 4; ++side) {
      if (!may_split(splitter, quads_.quads[q][side], quads_.quads[q][(side + 1) & 3])) continue;
      const int other = splitter.across(q, side);
      for (const auto& [first, second] : kPlaces)
        for (const HexagonFill fill : kFills)
          for (const HexagonFill fill_across : kFills) {
            const SideSplit split{q, side, first, second, fill, fill_across};
            if (!is_sound(split, other < 0) || (other < 0 && fill_across != kFills.front())) continue;
            out.push_back(measured(split, splitter, piece));
          }
    }
    return out;
  }

  Candidate measured(const SideSplit& split, const SideSplitter& splitter, const Workpiece& piece) const {
    Candidate candidate{split, path_of(split, splitter, piece)};
    const auto& path = candidate.path;
    const double straight = (path[3] - path[0]).norm();
    candidate.detour = straight > 0 ? ((path[1] - path[0]).norm() + (path[2] - path[1]).norm() + (path[3] - path[2]).norm()) / straight : 0;
    std::vector<int> changed;
    const QuadMesh mesh = splitter.split(split, candidate.path, &changed);
    candidate.quads = static_cast<int>(changed.size());
    for (const int k : changed) {
      const std::array<Vector3, 4> p = corners_of(mesh, k);
      candidate.flawed += !((p[2] - p[0]).cross(p[3] - p[1]).norm() > 0) || is_inverted(p, whole_, agreement_);
    }
    return candidate;
  }

  /// Not a side of a curve whose number of edges somebody asked for.
  bool may_split(const SideSplitter& splitter, int a, int b) const {
    const QuadMesh::FeatureEdge* edge = splitter.feature_edge(a, b);
    if (edge == nullptr) return true;
    return edge->curve >= 0 && edge->curve < static_cast<int>(features_.curves.size()) && features_.curves[edge->curve].asked_count == 0;
  }

  std::array<Vector3, 4> path_of(const SideSplit& split, const SideSplitter& splitter, const Workpiece& piece) const {
    const int a = quads_.quads[split.quad][split.side], b = quads_.quads[split.quad][(split.side + 1) & 3];
    const Vector3 &from = quads_.positions[a], &to = quads_.positions[b];
    const QuadMesh::FeatureEdge* edge = splitter.feature_edge(a, b);
    if (edge == nullptr) return {from, from + split.first * (to - from), from + split.second * (to - from), to};
    const CurveGeometry& curve = piece.curves[edge->curve];
    const auto arc_of = [&](int v, double end) { return quads_.kind[v] == VertexKind::kCurve ? piece.arc[v] : end; };
    const double begin = arc_of(edge->a, 0);
    double length = arc_of(edge->b, curve.length()) - begin;
    if (curve.closed() && length <= 0) length += curve.length();
    const auto at = [&](double part) { return curve.at(begin + (edge->a == a ? part : 1 - part) * length); };
    return {from, at(split.first), at(split.second), to};
  }

  void mend(QuadMesh& mesh, const std::vector<int>& flawed) const {
    Workpiece piece(mesh, input_, features_, index_);
    if (options_.target_length > 0) piece.h = options_.target_length;
    if (!(piece.h > 0)) return;
    piece.bind_all();
    SmootherOptions smoothing;
    smoothing.threads = context_.threads;
    Smoother smoother(piece, smoothing);
    smoother.update_frames(true);
    mend_flawed(piece, smoother, whole_, agreement_, context_, false, &flawed);
    mesh = piece.mesh.extract(piece.face);
  }

  QuadMesh& quads_;
  const TriangleMesh& input_;
  const FeatureGraph& features_;
  const SurfaceIndex& index_;
  const SurfaceIndex& whole_;
  const Agreement& agreement_;
  const ImproveOptions& options_;
  const RunContext& context_;
  FlawMemory memory_;
  int trials_left_ = 100;  ///< each takes some milliseconds for a thousand quads
};

}  // namespace

int split_flawed_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                       const ImproveOptions& options, const Agreement& agreement, const RunContext& context, const SurfaceIndex* whole) {
  return FlawedSplitter(quads, input, features, index, whole ? *whole : index, agreement, options, context).run();
}

}  // namespace hybrid_quad
