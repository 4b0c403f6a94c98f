#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "hybrid_quad/improve/flaw_memory.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/mend.h"
#include "hybrid_quad/improve/side_splitting.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/mesh/topology.h"

namespace hybrid_quad {

namespace {

constexpr std::array<std::array<double, 2>, 3> kPlaces{{{1.0 / 3, 2.0 / 3}, {0.2, 0.5}, {0.5, 0.8}}};

class FlawedSplitter {
 public:
  FlawedSplitter(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                 const SurfaceIndex& whole, const Agreement& agreement, const ImproveOptions& options, const RunContext& context,
                 int& trials)
      : quads_(quads), input_(input), features_(features), index_(index), whole_(whole), agreement_(agreement), options_(options),
        context_(context), trials_left_(trials), memory_(whole, agreement, mean_edge_length(quads)), futile_(mean_edge_length(quads)) {}

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

  struct Outcome {
    QuadMesh mesh;
    std::vector<int> flawed;
  };

  bool is_valid(const QuadMesh& mesh) const {
    return violations_of(mesh).empty() && topology_of(mesh) == topology_of(quads_);
  }

  /// Splits a side of a flawed quad: the first found that leaves fewer flawed ones, else the first that leaves as many; `flawed`
  /// then are these.
  bool split_any(std::vector<int>& flawed) {
    Workpiece piece(quads_, input_, features_, index_);
    piece.locate_all(context_);
    const SideSplitter splitter(quads_, index_, piece.region);
    std::optional<Outcome> best;
    for (const int q : flawed) {
      split_at(q, flawed.size(), splitter, piece, best);
      if (best && best->flawed.size() < flawed.size()) break;
    }
    if (!best) return false;
    quads_ = std::move(best->mesh);
    flawed = std::move(best->flawed);
    return true;
  }

  /// \param now  so many quads are flawed
  /// \param best  so far
  void split_at(int q, std::size_t now, const SideSplitter& splitter, const Workpiece& piece, std::optional<Outcome>& best) {
    constexpr int kTrialsASide = 8;
    context_.checkpoint();
    std::vector<Candidate> candidates = candidates_at(q, splitter, piece);
    std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
      return std::make_tuple(x.flawed, -x.detour, x.quads) < std::make_tuple(y.flawed, -y.detour, y.quads);
    });
    std::array<int, 4> trials{};
    for (const Candidate& candidate : candidates) {
      if (++trials[candidate.split.side] > kTrialsASide) continue;
      if (--trials_left_ < 0) return;
      std::vector<int> changed;
      QuadMesh mesh = splitter.split(candidate.split, candidate.path, &changed);
      if (candidate.flawed > 0) mend(mesh, memory_.flawed_of(mesh));
      std::vector<int> left = memory_.flawed_of(mesh);
      if (left.size() > now || (best && left.size() >= best->flawed.size()) || !is_valid(mesh)) continue;
      best = Outcome{std::move(mesh), std::move(left)};
      if (best->flawed.size() < now) return;
    }
  }

  std::vector<Candidate> candidates_at(int q, const SideSplitter& splitter, const Workpiece& piece) {
    std::vector<Candidate> out;
    for (int side = 0; side < 4; ++side) {
      if (!may_split(edge_of(splitter, q, side), features_)) continue;
      for (const auto& [first, second] : kPlaces)
        for (SideSplit split : sound_splits(q, side, splitter.across(q, side) < 0)) {
          split.first = first;
          split.second = second;
          out.push_back(measured(split, splitter, piece));
        }
    }
    return out;
  }

  Candidate measured(const SideSplit& split, const SideSplitter& splitter, const Workpiece& piece) {
    Candidate candidate{split, path_of(quads_, piece, edge_of(splitter, split.quad, split.side), split)};
    const auto& path = candidate.path;
    const double straight = (path[3] - path[0]).norm();
    candidate.detour = straight > 0 ? ((path[1] - path[0]).norm() + (path[2] - path[1]).norm() + (path[3] - path[2]).norm()) / straight : 0;
    std::vector<int> changed;
    const QuadMesh mesh = splitter.split(split, candidate.path, &changed);
    candidate.quads = static_cast<int>(changed.size());
    for (const int k : changed) candidate.flawed += memory_.is_flawed(mesh, k);
    return candidate;
  }

  const QuadMesh::FeatureEdge* edge_of(const SideSplitter& splitter, int q, int side) const {
    return splitter.feature_edge(quads_.quads[q][side], quads_.quads[q][(side + 1) & 3]);
  }

  void mend(QuadMesh& mesh, const std::vector<int>& flawed) {
    Workpiece piece(mesh, input_, features_, index_);
    if (options_.target_length > 0) piece.h = options_.target_length;
    if (!(piece.h > 0)) return;
    piece.locate_all(context_);
    SmootherOptions smoothing;
    smoothing.threads = context_.threads;
    Smoother smoother(piece, smoothing);
    mend_listed(piece, smoother, whole_, agreement_, context_, flawed, futile_);
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
  int& trials_left_;
  FlawMemory memory_;
  FutileMending futile_;
};

}  // namespace

int split_flawed_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                       const ImproveOptions& options, const Agreement& agreement, const RunContext& context, const SurfaceIndex* whole,
                       int* trials) {
  int usual = 200;  // each takes some milliseconds for a thousand quads
  return FlawedSplitter(quads, input, features, index, whole ? *whole : index, agreement, options, context, trials ? *trials : usual).run();
}

}  // namespace hybrid_quad
