#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "hybrid_quad/improve/flaw_memory.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/local_refinement.h"
#include "hybrid_quad/improve/mend.h"
#include "hybrid_quad/improve/smoother.h"
#include "hybrid_quad/improve/workpiece.h"
#include "hybrid_quad/mesh/topology.h"

namespace hybrid_quad {

namespace {

/// For the areas of quads, against their shapes: with equal areas tangles come apart, and from where one weight leads to a dead
/// end another leads on.
constexpr std::array<double, 4> kAreaWeights{2, 8, 0.5, 30};

class FlawedRefiner {
 public:
  FlawedRefiner(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                const SurfaceIndex& whole, const Agreement& agreement, const ImproveOptions& options, const RunContext& context)
      : quads_(quads), input_(input), features_(features), index_(index), whole_(whole), agreement_(agreement), options_(options),
        context_(context), memory_(whole, agreement, mean_edge_length(quads)), rounds_left_(rounds_for(quads.quads.size())) {}

  int run() {
    constexpr std::size_t kMostFlawed = 24;
    int places = 0;
    flawed_ = memory_.flawed_of(quads_);
    if (flawed_.size() > kMostFlawed) return 0;
    while (!flawed_.empty() && refine_any()) ++places;
    return places;
  }

 private:
  static constexpr std::size_t kFew = 3;
  static constexpr int kMostRounds = 8, kMostRings = 4;  ///< with one refinement, and of it

  /// Each takes some ten milliseconds for a thousand quads; always enough for one flawed quad.
  static int rounds_for(std::size_t quads) {
    constexpr std::size_t kMost = 100, kWork = 1000000;
    return static_cast<int>(std::max<std::size_t>(kMostRounds * kMostRings, std::min(kMost, kWork / quads)));
  }

  /// Around the first flawed quad where that leaves fewer; else once more, around what is flawed in the nearest to it.
  bool refine_any() {
    constexpr int kMostRingsAgain = 2;
    fewest_left_ = std::numeric_limits<std::size_t>::max();
    if (refine_around(quads_, flawed_, kMostRings) || split_nearest()) return true;
    if (fewest_left_ > kFew) return false;
    const QuadMesh again = nearest_;
    return refine_around(again, memory_.flawed_of(again), kMostRingsAgain) || split_nearest();
  }

  bool refine_around(const QuadMesh& mesh, const std::vector<int>& flawed, int most_rings) {
    for (const int q : flawed)
      for (int rings = 1; rings <= most_rings; ++rings) {
        if (rounds_left_ < kMostRounds) return false;
        if (refine(mesh, q, rings)) return true;
      }
    return false;
  }

  /// What was refined without success lacks little, mostly: sides split there may do it.
  bool split_nearest() {
    if (fewest_left_ > kFew) return false;
    QuadMesh mesh = nearest_;
    split_flawed_quads(mesh, input_, features_, index_, options_, agreement_, context_, &whole_, &split_trials_left_);
    return memory_.flawed_of(mesh).size() < flawed_.size() && take_if_better(mesh);
  }

  bool refine(const QuadMesh& from, int q, int rings) {
    std::vector<int> touched;
    Workpiece piece = located(refined(from, q, rings, &touched));
    for (int round = 0; round < kMostRounds; ++round) {
      --rounds_left_;
      context_.checkpoint();
      relax(piece, touched, kAreaWeights[round % kAreaWeights.size()]);
      QuadMesh mesh = mended(piece);
      if (take_if_better(mesh)) return true;
    }
    return false;
  }

  bool take_if_better(QuadMesh& mesh) {
    std::vector<int> left = memory_.flawed_of(mesh);
    const bool is_better = left.size() < flawed_.size();
    if (!is_better && left.size() >= fewest_left_) return false;
    if (!violations_of(mesh).empty() || topology_of(mesh) != topology_of(quads_)) return false;
    fewest_left_ = left.size();
    if (is_better) {
      quads_ = std::move(mesh);
      flawed_ = std::move(left);
    } else {
      nearest_ = std::move(mesh);
    }
    return is_better;
  }

  Workpiece located(const QuadMesh& mesh) const {
    Workpiece piece(mesh, input_, features_, index_);
    if (options_.target_length > 0) piece.h = options_.target_length;
    piece.locate_all(context_);
    return piece;
  }

  QuadMesh refined(const QuadMesh& mesh, int q, int rings, std::vector<int>* touched) const {
    const Workpiece piece = located(mesh);
    std::vector<char> chosen(mesh.quads.size(), 0);
    chosen[q] = 1;
    std::vector<int> quads{q};
    for (int ring = 0; ring < rings; ++ring)
      for (const int other : quads_around(piece.mesh, vertices_of(piece.mesh, quads)))
        if (!chosen[other]) {
          chosen[other] = 1;
          quads.push_back(other);
        }
    return refine_locally(mesh, piece, chosen, touched);
  }

  static std::vector<int> vertices_of(const EditMesh& mesh, const std::vector<int>& quads) {
    std::vector<int> vertices;
    for (const int q : quads) vertices.insert(vertices.end(), mesh.quad(q).begin(), mesh.quad(q).end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  static std::vector<int> quads_around(const EditMesh& mesh, const std::vector<int>& vertices) {
    std::vector<int> quads;
    for (const int v : vertices) quads.insert(quads.end(), mesh.quads_at(v).begin(), mesh.quads_at(v).end());
    std::sort(quads.begin(), quads.end());
    quads.erase(std::unique(quads.begin(), quads.end()), quads.end());
    return quads;
  }

  SmootherOptions smoothing() const {
    SmootherOptions options;
    options.threads = context_.threads;
    return options;
  }

  /// From what hardly minds folds to what hardly bears them, twice: what the first leaves folded the second unfolds, often.
  void relax(Workpiece& piece, const std::vector<int>& vertices, double area_weight) const {
    constexpr int kTimes = 2, kSweeps = 20;
    constexpr std::array<double, 5> kRegularisation{0.5, 0.2, 0.07, 0.02, 1e-3};
    SmootherOptions options = smoothing();
    options.area_weight = area_weight;
    Smoother smoother(piece, options);
    const std::vector<int> quads = quads_around(piece.mesh, vertices);
    smoother.update_frames(quads_around(piece.mesh, vertices_of(piece.mesh, quads)), true);
    for (int time = 0; time < kTimes; ++time)
      for (const double eps : kRegularisation) {
        smoother.relax(vertices, kSweeps, eps);
        smoother.update_frames(quads, true);
      }
  }

  /// A mended copy; relaxing goes on without what mending did, which is a dead end for it where it was not enough.
  QuadMesh mended(const Workpiece& relaxed) {
    constexpr std::size_t kWorthMending = 32;
    QuadMesh mesh = relaxed.mesh.extract(relaxed.face);
    const std::vector<int> flawed = memory_.flawed_of(mesh);
    if (flawed.empty() || flawed.size() > kWorthMending) return mesh;
    Workpiece piece = relaxed;
    Smoother smoother(piece, smoothing());
    FutileMending futile(piece.h);
    mend_listed(piece, smoother, whole_, agreement_, context_, flawed, futile);
    return piece.mesh.extract(piece.face);
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
  std::vector<int> flawed_;
  QuadMesh nearest_;  ///< refined, with as few flawed as any that was not kept
  std::size_t fewest_left_ = 0;
  int rounds_left_;
  int split_trials_left_ = 150;  ///< of sides, for all that was refined: where they help, the first hundred or so do
};

}  // namespace

int refine_flawed_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                        const ImproveOptions& options, const Agreement& agreement, const RunContext& context,
                        const SurfaceIndex* whole) {
  return FlawedRefiner(quads, input, features, index, whole ? *whole : index, agreement, options, context).run();
}

}  // namespace hybrid_quad
